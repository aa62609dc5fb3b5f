# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the measured costs with the project's aims. Aims that are missed are shown too.

Aims of time apply to every scene. Aims of error at equal time apply to surfaces under a sun without
size. They compare with two plain estimators, which take one unstratified walk per shading point
with the same kernel. One walk has our first bounce. Whole walk draws the first bounce too
(shaders.py).
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from .curves import advantage, advantages, time_ratio, time_ratios
from .findings import SceneFindings
from .plan import BOUNCES, CYCLES, FITTED, ONE_WALK, SINGLE, WALK, WHOLE_WALK

MOST_FITTED = 1.1
MOST_WALK = 2.0
MOST_GROWTH = 1.3
LEAST_WALK_GAIN = 10.0
LEAST_FITTED_GAIN = 100.0
# Errors are compared at the time of so many samples of the baseline.
TOLD_AT = 16


@dataclass(frozen=True)
class Target:
    """One aim on one scene.

    aim   -- in words, such as "Fitted takes at most 1.1 times as long as Cycles"
    value -- the measured ratio; nan if the two variants share no time
    low, high -- range of the value over `span`, "rounds" or "times"
    limit -- the aimed value, an upper limit if `at_most`, else a lower one
    """

    aim: str
    scene: str
    value: float
    low: float
    high: float
    limit: float
    at_most: bool
    span: str

    @property
    def reached(self) -> bool:
        """Whether the value keeps the limit. An unknown value never does."""
        return self.value <= self.limit if self.at_most else self.value >= self.limit

    def as_dict(self) -> dict[str, object]:
        """The fields and `reached`, for JSON."""
        return {**asdict(self), "reached": self.reached}


def targets(found: Mapping[str, SceneFindings]) -> list[Target]:
    """All aims, each on every scene that has its variants."""
    made = []
    few, many = (f"MaxBounces {count}" for count in (BOUNCES[1], BOUNCES[-1]))
    costs = (
        (FITTED, CYCLES, MOST_FITTED, "Fitted takes at most {:g} times as long as Cycles' own"),
        (WALK, SINGLE, MOST_WALK, "Walk takes at most {:g} times as long as Single"),
        *(
            (f"{quality}, {many}", f"{quality}, {few}", MOST_GROWTH,
             f"{quality} takes at most {{:g}} times as long with {BOUNCES[-1]} bounces as with 2")
            for quality in (WALK, FITTED)
        ),
    )  # fmt: skip
    for ours, theirs, limit, aim in costs:
        made += [
            _cost(one, ours, theirs, limit, aim)
            for one in found.values()
            if ours in one.curves and theirs in one.curves
        ]
    under_sun = [s for s in found.values() if s.scene.directional and not s.scene.is_sweep]
    for quality, limit in ((WALK, LEAST_WALK_GAIN), (FITTED, LEAST_FITTED_GAIN)):
        for plain in (ONE_WALK, WHOLE_WALK):
            made += [
                _gain(one, quality, plain, limit)
                for one in under_sun
                if quality in one.curves and plain in one.curves
            ]
    return made


def _cost(one: SceneFindings, ours: str, theirs: str, limit: float, aim: str) -> Target:
    pair = one.curves[ours], one.curves[theirs]
    ratios = time_ratios(*pair)
    return Target(aim.format(limit), one.scene.title, time_ratio(*pair), min(ratios), max(ratios),
                  limit, True, "rounds")  # fmt: skip


def _gain(one: SceneFindings, quality: str, baseline: str, limit: float) -> Target:
    """The aim for a quality's error against a plain estimator's at equal time.

    That time is TOLD_AT samples of the estimator, or the nearest that both have.
    """
    ours, plain = one.curves[quality], one.curves[baseline]
    every = advantages(ours, plain)
    value = low = high = math.nan
    if every:
        seconds = min(max(TOLD_AT * plain.a_sample, every[0][0]), every[-1][0])
        values = [found for _, found in every]
        value, low, high = advantage(ours, plain, seconds), min(values), max(values)
    aim = f"{quality} has at least {limit:g} times less squared error than {baseline}"
    return Target(aim, one.scene.title, value, low, high, limit, False, "times")
