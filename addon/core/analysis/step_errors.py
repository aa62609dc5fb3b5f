# SPDX-License-Identifier: GPL-3.0-or-later
"""The measured losses, errors and costs of each Quality (step_errors.toml)."""

from bisect import bisect_left
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from ..kinds import kind_named

FILE = Path(__file__).with_name("step_errors.toml")
STEPS = ("Single", "Fitted", "Walk")
NAMES = ("GGX", "BECKMANN")  # of the distributions, by the numbers of the parameter Distribution

# Sorts of surfaces with measured errors. The models are numbers of the parameter Model.
ISOTROPIC, ANISOTROPIC = "isotropic", "anisotropic"

Interval = tuple[float, float]


def left_out(
    kind: str,
    distribution: int,
    model: int,
    alphas: Interval,
    iors: Interval = (1.5, 1.5),
    of: str = "left_out",
) -> tuple[float, ...]:
    """Return what is missing after bounce 1, 2, ... if facets absorb nothing.

    alphas -- smallest and largest larger alpha, 0 to 1
    iors   -- of glass, and 1 over them alike
    of     -- "left_out" for image L2, "lost" for energy

    It is the most over both intervals, from the closest measured indices on both sides. It is
    linear between alphas, which is too much rather than too little.
    """
    by_index = _by_index(of, kind_named(kind).identifier, NAMES[distribution], model)
    wanted = _around(sorted(by_index), iors) if kind == "DIELECTRIC" else by_index
    rows = [by_index[index] for index in wanted]
    count = max(len(numbers) for row in rows for numbers in row)
    nodes = (0.0, *_tables()["alphas"])

    def missing(row: list[list[float]], bounce: int) -> float:
        values = [0.0, *(numbers[bounce] if bounce < len(numbers) else 0.0 for numbers in row)]
        return most(nodes, values, alphas)

    return tuple(max(missing(row, bounce) for row in rows) for bounce in range(count))


def off(kind: str, distribution: int, sort: str, step: str, alphas: Interval) -> float:
    """Return the largest error of the converged picture, as image L2, over the larger `alphas`.

    `step` is one of STEPS. For Single it is the error of the first bounce. A `sort` that was not
    measured for this distribution takes the other's error, or that of isotropic surfaces.
    """
    name = NAMES[distribution]
    for wanted in ((sort, name), (sort, "GGX"), (ISOTROPIC, name)):
        for row in _tables()["off"]:
            if (row["sort"], row["distribution"]) == wanted and (row["kind"], row["step"]) == (
                kind,
                step,
            ):
                return most((0.0, *row["alphas"]), (0.0, *row["errors"]), alphas)
    return 0.0


def cost(kind: str, step: str, alphas: Interval) -> float:
    """Return the largest cost of a sample over the larger `alphas`; that of metal of alpha 0.25 in
    Single is 1."""
    table = _tables()
    (row,) = (row for row in table["costs"] if (row["kind"], row["step"]) == (kind, step))
    return most(table["cost_alphas"], row["costs"], alphas)


def background() -> float:
    """Return the cost of a sample of a pixel that shows only the world, in the units of cost()."""
    return _tables()["background"]


def most(nodes: Sequence[float], values: Sequence[float], interval: Interval) -> float:
    """Return the largest value over an interval, linear between rising nodes and flat outside."""
    low, high = interval
    inside = [value for node, value in zip(nodes, values, strict=True) if low <= node <= high]
    return max(_at(nodes, values, low), _at(nodes, values, high), *inside)


def _at(nodes: Sequence[float], values: Sequence[float], place: float) -> float:
    above = bisect_left(nodes, place)
    if above in (0, len(nodes)):
        return values[min(above, len(nodes) - 1)]
    part = (place - nodes[above - 1]) / (nodes[above] - nodes[above - 1])
    return (1.0 - part) * values[above - 1] + part * values[above]


def _around(nodes: Sequence[float], iors: Interval) -> set[float]:
    """Return the measured indices within `iors` and the nearest on both sides."""
    outside = [max(ior, 1.0 / max(ior, 1e-6)) for ior in iors]
    low = 1.0 if iors[0] < 1.0 < iors[1] else min(outside)
    below = max((node for node in nodes if node <= low), default=nodes[0])
    above = min((node for node in nodes if node >= max(outside)), default=nodes[-1])
    return {node for node in nodes if below <= node <= above}


@cache
def _by_index(of: str, kind: str, distribution: str, model: int) -> dict[float, list[list[float]]]:
    """Return what is missing by alpha and bounce, by the index of glass (0 for other kinds)."""
    return {
        row["ior"]: row["after"]
        for row in _tables()[of]
        if (row["kind"], row["distribution"], row["model"]) == (kind, distribution, model)
    }


@cache
def _tables() -> dict:
    import tomllib  # not needed before the first analysis

    with FILE.open("rb") as file:
        return tomllib.load(file)
