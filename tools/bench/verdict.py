# SPDX-License-Identifier: GPL-3.0-or-later
"""Says in words where Cycles' own closures are the better choice, and where ours are."""

import math
from collections.abc import Sequence

from addon.core.cost.statistics import ErrorSplit

from .curves import advantages, time_ratio
from .findings import SceneFindings
from .plan import CYCLES, FITTED, ONE_WALK, WALK
from .targets import TOLD_AT

_CLEAR = 3.0  # converged errors differ if they are so many standard errors apart


def moment(one: SceneFindings) -> tuple[str, float]:
    """The baseline of errors at equal time, and the seconds of TOLD_AT of its samples."""
    baseline = next((n for n in (ONE_WALK, CYCLES) if n in one.curves), next(iter(one.curves)))
    return baseline, TOLD_AT * one.curves[baseline].a_sample


def losses(found: Sequence[SceneFindings]) -> list[str]:
    """A sentence for each scene and quality in which Cycles has the smaller error."""
    lines = []
    for one in found:
        for quality in (FITTED, WALK):
            lines += _lost(one, quality)
    return lines


def wins(found: Sequence[SceneFindings]) -> list[str]:
    """A sentence for each scene and quality that ends with a smaller error than Cycles."""
    lines = []
    for one in found:
        for quality in (FITTED, WALK):
            every = _over_cycles(one, quality)
            ahead = [(seconds, value) for seconds, value in every if value > 1.0]
            if not ahead or every[-1][1] <= 1.0:
                continue
            start = _last_start(every)
            when = (
                "at all times that both have" if start <= every[0][0] else f"from {start:.2g} s on"
            )
            lines.append(
                f"{one.scene.title}: {quality} has the smaller error {when}. In the end its "
                f"squared error is {times_text(every[-1][1])} times smaller."
            )
    return lines


def _lost(one: SceneFindings, quality: str) -> list[str]:
    every = _over_cycles(one, quality)
    if not every:
        return []
    lines = []
    behind = [value for _, value in every if value < 1.0]
    title = one.scene.title
    if len(behind) == len(every):
        lines.append(
            f"{title}: {quality} has the larger error at all times that both have, "
            f"{every[0][0]:.2g} to {every[-1][0]:.2g} s. Its squared error is "
            f"{times_text(1.0 / max(behind))} to {times_text(1.0 / min(behind))} times Cycles'."
        )
    elif behind:
        lines.append(
            f"{title}: {quality} has the larger error until {_last_start(every):.2g} s. Its "
            f"squared error is up to {times_text(1.0 / min(behind))} times Cycles'."
            if every[-1][1] > 1.0
            else f"{title}: {quality} has the larger error in the end. Its squared error is "
            f"{times_text(1.0 / every[-1][1])} times Cycles'."
        )
    ours, theirs = one.curves[quality], one.curves[CYCLES]
    mine, other = ours.bias, theirs.bias
    if mine and other and _clearly(mine, other):
        lines.append(
            f"{title}: converged, {quality} is {100 * mine.bias:.2f} % off and Cycles "
            f"{100 * other.bias:.2f} %. A sample takes {time_ratio(ours, theirs):.2f} times as "
            "long."
        )
    return lines


def _over_cycles(one: SceneFindings, quality: str) -> list[tuple[float, float]]:
    if quality not in one.curves or CYCLES not in one.curves:
        return []
    return advantages(one.curves[quality], one.curves[CYCLES])


def _last_start(every: list[tuple[float, float]]) -> float:
    """The first time from which ours stays ahead up to the end."""
    start = every[-1][0]
    for seconds, value in reversed(every):
        if value <= 1.0:
            break
        start = seconds
    return start


def times_text(value: float) -> str:
    """A ratio with two figures, or as a whole number from 10 on."""
    return f"{value:.2g}" if value < 9.95 else f"{value:.0f}"


def _clearly(larger: ErrorSplit, smaller: ErrorSplit) -> bool:
    error = math.hypot(larger.bias_square_se, smaller.bias_square_se)
    return larger.bias_square - smaller.bias_square > _CLEAR * error
