# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader's functions across each of their branches: from one float32 number to the next the
value moves by at most 1e-3, or by what the oracle moves as well."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from blender_tests.osl.samples import SURFACE

from .arguments import single
from .functions import FUNCTIONS, Function
from .verdicts import LARGEST_ERROR, Case, columns_of, values, wanted

_UP = {"view": (0.0, 0.0, 1.0)}
_NO_ORACLE = {"oracle": lambda **columns: np.empty((len(next(iter(columns.values()))), 0))}
BENT = Function("frame.h", "result = visible_normal(n, view);", {}, floor=1.0, **_NO_ORACLE)
BECKMANN_NORMAL = Function(
    "visible.h",
    f"{SURFACE} Incidence arrival = incidence(surface, view);"
    "result = sample_visible_normal(surface, arrival, xi);",
    {},
    floor=1.0,
    **_NO_ORACLE,
)


def around(value: float, steps: int = 6) -> list[float]:
    """The float32 numbers about `value`, in order; about 0 powers of ten, for the steps are none
    that Cycles would tell from 0."""
    if value == 0.0:
        powers = [10.0**power for power in (-6, -8, -12, -20, -30)]
        return [*(-p for p in powers), -0.0, 0.0, *reversed(powers)]
    low = high = np.float32(value)
    both = [low]
    for _ in range(steps):
        low, high = np.nextafter(low, np.float32(-9)), np.nextafter(high, np.float32(9))
        both = [low, *both, high]
    return [float(one) for one in both]


def _slanted(z: float) -> tuple[float, float, float]:
    return single(np.sqrt(1.0 - z * z)), 0.0, z


def _areas_far_below(alpha: float) -> list[Case]:
    """Beckmann's tail ends where the cotangent is 9."""
    t = 1.0 / np.hypot(1.0, 9.0 * alpha)
    place = 9.0 * alpha * t
    return [{"alpha": (alpha, alpha, 1.0), "view": _slanted(z)} for z in around(place)]


def _at_horizon(name: str, kind: float, **others: object) -> Callable[[float], list[Case]]:
    def cases(alpha: float) -> list[Case]:
        fixed = {"alpha": (alpha, alpha, kind), **others}
        return [{**fixed, name: _slanted(z)} for z in around(0.0)]

    return cases


def _critical(eta: float) -> list[Case]:
    cosine = np.sqrt(max(1.0 - single(eta) ** 2, 0.0))
    return [{"eta": single(eta), "cosine": c} for c in around(cosine)]


def _critical_ray(eta: float) -> list[Case]:
    rows = _critical(eta)
    upright = {"eta": single(eta), "m": (0.0, 0.0, 1.0)}
    return [{**upright, "view": _slanted(row["cosine"])} for row in rows if row["cosine"] < 1.0]


def _index_near_one(cosine: float) -> list[Case]:
    return [{"eta": eta, "cosine": cosine} for eta in around(1.0)]


def _steeper_than_half(eta: float) -> list[Case]:
    """From cosine 0.7 on the refracted cosine is taken from the sines."""
    return [{"eta": single(eta), "cosine": c} for c in around(0.7)]


def _number(name: str) -> Callable[[float], list[Case]]:
    def cases(value: float) -> list[Case]:
        return [{name: one} for one in around(value)]

    return cases


def _part(end: float) -> list[Case]:
    return [{"part": one} for one in around(end) if 0.0 <= one <= 1.0]


def _crossing_at_horizon(name: str, **others: object) -> Callable[[float], list[Case]]:
    """Where the cosine over the area alpha / 2 comes to its floor of 1e-18."""

    def cases(alpha: float) -> list[Case]:
        fixed = {"alpha": (alpha, alpha, 0.0), **others}
        return [{**fixed, name: _slanted(z)} for z in around(1e-18 * 0.5 * alpha)]

    return cases


def _metal(first: float, second: float) -> Callable[[float], list[Case]]:
    def cases(cosine: float) -> list[Case]:
        colours = {"f0": (single(first),) * 3, "f1": (single(second),) * 3}
        return [{**colours, "cosine": c} for c in around(cosine)]

    return cases


def _bound_reaches_one(alpha: float) -> list[Case]:
    return [
        {"alpha": (alpha, alpha, 0.0), "view": _slanted(z)} for z in around(np.sqrt(1.4) * alpha)
    ]


def _whole_lobe(spread: float) -> list[Case]:
    return [{"z": z, "spread": spread} for z in around(4.0 * spread)]


def _barely_seen(z: float) -> list[Case]:
    return [{**_UP, "n": _slanted(c)} for c in around(z)]


@dataclass(frozen=True)
class Branch:
    """Runs of neighbouring cases over a branch, one for each of `places`."""

    function: Function
    cases: Callable[[float], list[Case]]
    places: tuple[float, ...]


_SIDES = {"view": _slanted(0.5)}
_UNIFORMS = {"xi": (0.3, 0.6, 0.5)}
_ALPHAS = (single(1e-4), 0.125, 1.0)
_ETAS = (0.2, 1.0 / 1.5, 1.0 / 1.0001)

BRANCHES = {
    "areas, end of Beckmann's tail": Branch(
        FUNCTIONS["projected areas"], _areas_far_below, (0.01, 0.0625, 0.125)
    ),
    "areas at the horizon, GGX": Branch(
        FUNCTIONS["projected areas"], _at_horizon("view", 0.0), _ALPHAS
    ),
    "areas at the horizon, Beckmann": Branch(
        FUNCTIONS["projected areas"], _at_horizon("view", 1.0), _ALPHAS
    ),
    "exits at the horizon": Branch(
        FUNCTIONS["exit_probability"], _at_horizon("o", 0.0, **_SIDES), _ALPHAS
    ),
    "exits at the horizon, uncorrelated": Branch(
        FUNCTIONS["exit_probability"], _at_horizon("o", 3.0, **_SIDES), _ALPHAS
    ),
    "exits of views at the horizon": Branch(
        FUNCTIONS["exit_probability"], _at_horizon("view", 0.0, o=_slanted(0.25)), _ALPHAS
    ),
    "crossing, exits at the horizon": Branch(
        FUNCTIONS["crossing_probability"], _crossing_at_horizon("o", **_SIDES), _ALPHAS
    ),
    "crossing, views at the horizon": Branch(
        FUNCTIONS["crossing_probability"], _crossing_at_horizon("view", o=_slanted(0.25)), _ALPHAS
    ),
    "series of log(1 + z) / z": Branch(FUNCTIONS["log1p_over"], _number("number"), (0.01,)),
    "series of 1 - exp(x)": Branch(FUNCTIONS["one_minus_exp"], _number("log_u"), (-0.01,)),
    "Stirling's remainder at its ends": Branch(FUNCTIONS["stirling_remainder"], _part, (0.0, 1.0)),
    "escapes at the horizon": Branch(
        FUNCTIONS["escape_chance"], _at_horizon("o", 4.0, log_u=-0.5), _ALPHAS
    ),
    "heights met at the horizon": Branch(
        FUNCTIONS["height_met"], _at_horizon("view", 0.0, number=0.5), _ALPHAS
    ),
    "next heights at the horizon": Branch(
        FUNCTIONS["next_height"], _at_horizon("o", 4.0, log_u=-0.5, number=0.5), _ALPHAS
    ),
    "normals at the horizon, GGX": Branch(
        FUNCTIONS["sample_visible_normal, GGX"], _at_horizon("view", 0.0, **_UNIFORMS), _ALPHAS
    ),
    "normals at the horizon, Beckmann": Branch(
        BECKMANN_NORMAL, _at_horizon("view", 1.0, **_UNIFORMS), _ALPHAS
    ),
    "critical angle": Branch(FUNCTIONS["dielectric_fresnel"], _critical, _ETAS),
    "refraction at the critical angle": Branch(FUNCTIONS["refracted"], _critical_ray, _ETAS),
    "glass, cosine 0.7": Branch(
        FUNCTIONS["dielectric_fresnel"], _steeper_than_half, (*_ETAS, 0.72, 1.0001, 5.0)
    ),
    "glass that is hardly there": Branch(
        FUNCTIONS["dielectric_fresnel"], _index_near_one, (single(1e-4), 0.125, 1.0)
    ),
    "n^2 - k^2 = sin^2": Branch(FUNCTIONS["n and k"], _metal(1.0, 0.3), (0.3,)),
    "metal without k": Branch(FUNCTIONS["n and k"], _metal(0.5, 0.0), (np.sqrt(0.75),)),
    "F82 tint of 0": Branch(FUNCTIONS["F82 tint"], _metal(0.0, 0.0), (1.0 / 7.0,)),
    "bound of the energy": Branch(
        FUNCTIONS["missing_energy_bound"], _bound_reaches_one, (single(1e-4), 0.125, 0.5)
    ),
    "lobe wholly on one side": Branch(
        FUNCTIONS["fraction_on_side"], _whole_lobe, (single(1e-4), 0.125)
    ),
    "normals bent into view": Branch(BENT, _barely_seen, (1e-4,)),
}


def jumps(function: Function, cases: list[Case]) -> np.ndarray:
    """By how much the value moves between neighbours beyond what the oracle does, relative, (n - 1,
    channels); nan where a value is not finite."""
    columns = columns_of(cases)
    found = values(function, columns)
    low, high = wanted(function, columns)
    if low.shape[1]:
        found = found[:, : low.shape[1]]  # the rest is copies
    explained = np.maximum(high[1:], high[:-1]) - np.minimum(low[1:], low[:-1])
    if not low.shape[1]:
        explained = np.zeros_like(found[1:])
    size = np.maximum(np.maximum(np.abs(found[1:]), np.abs(found[:-1])), function.floor)
    moved = np.abs(np.diff(found, axis=0))
    return np.maximum(moved - explained, 0.0) / size


@pytest.mark.parametrize("name", BRANCHES)
def test_continuous(name: str, report) -> None:
    branch = BRANCHES[name]
    largest = 0.0
    for place in branch.places:
        cases = branch.cases(place)
        found = jumps(branch.function, cases)
        row = int(np.argmax(np.max(np.nan_to_num(found, nan=np.inf), axis=1)))
        largest = max(largest, found[row].max())
        assert found[row].max() <= LARGEST_ERROR, f"{cases[row]} and {cases[row + 1]}"
    report(f"continuity, {name}", f"{largest:.1e}", f"{LARGEST_ERROR:g}")
