# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the time ratios of a quick run against stored ones: what got slower, and by how much.

Seconds differ from machine to machine, ratios of two variants of one scene far less. A ratio is
the median over interleaved rounds. The margin comes from how far the rounds were apart in both
runs: three standard errors of the two medians' difference. It is no less than SMALLEST_MARGIN,
which other processors and versions of Blender take.
"""

import json
import math
import statistics
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from .curves import time_ratios
from .findings import SceneFindings
from .plan import CYCLES, CYCLES_SVM, EXACT, FITTED, ONE_WALK, SINGLE, WALK

SMALLEST_MARGIN = 0.15
DEVIATIONS = 3.0
# Standard deviation over the median distance from the median, and standard error of a median over
# that of a mean: both of normal distributions.
_PER_MEDIAN_DISTANCE = 1.4826
_PER_MEAN = 1.2533

# What is compared: scene, variant, and the variant that its time is divided by.
CHECKED = (
    ("showcase", FITTED, CYCLES),
    ("showcase", FITTED, SINGLE),
    ("showcase", WALK, SINGLE),
    ("showcase", EXACT, SINGLE),
    ("showcase", CYCLES, CYCLES_SVM),
    ("slab_0.6", FITTED, SINGLE),
    ("slab_0.6", WALK, SINGLE),
    ("slab_0.6", WALK, ONE_WALK),
    ("slab_0.6", FITTED, CYCLES),
    ("sun_white", FITTED, CYCLES),
    ("sun_white", WALK, SINGLE),
    ("sun_white", WALK, ONE_WALK),
    ("bounces_showcase", "Walk, MaxBounces 16", "Walk, MaxBounces 2"),
)


class RatiosError(RuntimeError):
    """The stored ratios are missing or are not what they should be; the message has the remedy."""


@dataclass(frozen=True)
class Ratio:
    """A ratio of times: median of the rounds, and the standard error of that relative to it."""

    median: float
    error: float


def ratio(rounds: list[float] | tuple[float, ...]) -> Ratio:
    """The ratio of some rounds, at least one."""
    median = statistics.median(rounds)
    distance = statistics.median(abs(one - median) for one in rounds)
    error = _PER_MEDIAN_DISTANCE * distance * _PER_MEAN / math.sqrt(len(rounds))
    return Ratio(median, error / median)


def ratios(found: Mapping[str, SceneFindings]) -> dict[str, Ratio]:
    """All of CHECKED by their names; raises KeyError where a scene or variant was not measured."""
    return {
        f"{scene}: {ours} / {theirs}": ratio(
            time_ratios(found[scene].curves[ours], found[scene].curves[theirs])
        )
        for scene, ours, theirs in CHECKED
    }


def write_ratios(found: Mapping[str, Ratio], machine: Mapping[str, object]) -> str:
    """The text of ratios.json."""
    stored = {name: {key: round(value, 5) for key, value in asdict(one).items()}
              for name, one in found.items()}  # fmt: skip
    return json.dumps({"machine": dict(machine), "ratios": stored}, indent=2) + "\n"


def read_ratios(path: Path) -> dict[str, Ratio]:
    """Stored ratios by name. Raises RatiosError."""
    remedy = "record them with 'python -m blender_tests.bench --quick --record'"
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))["ratios"]
        found = {
            name: Ratio(float(one["median"]), float(one["error"])) for name, one in stored.items()
        }
    except OSError as error:
        raise RatiosError(f"{path.name} cannot be read ({error.strerror}): {remedy}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RatiosError(f"{path.name} holds no ratios ({error!r}): {remedy}") from error
    bad = [name for name, one in found.items() if not (one.median > 0.0 and one.error >= 0.0)]
    if bad or not found:
        raise RatiosError(
            f"{path.name} has no positive ratio of {', '.join(bad) or 'all'}: {remedy}"
        )
    return found


@dataclass(frozen=True)
class Verdict:
    """One ratio beside the stored one; ``change`` is relative, positive for slower."""

    name: str
    stored: Ratio
    found: Ratio

    @property
    def change(self) -> float:
        """0.2 for a ratio that grew by a fifth."""
        return self.found.median / self.stored.median - 1.0

    @property
    def margin(self) -> float:
        """The change that is allowed."""
        return max(SMALLEST_MARGIN, DEVIATIONS * math.hypot(self.stored.error, self.found.error))

    @property
    def slower(self) -> bool:
        """Whether it grew by more than the margin."""
        return self.change > self.margin

    def __str__(self) -> str:
        word = "slower" if self.change > 0 else "faster"
        return (
            f"{self.name} is {self.found.median:.2f}, stored {self.stored.median:.2f}: "
            f"{abs(self.change):.0%} {word} (margin {self.margin:.0%})"
        )


def compare(stored: Mapping[str, Ratio], found: Mapping[str, Ratio]) -> list[Verdict]:
    """Every stored ratio beside the found one, the worst first.

    Raises RatiosError where they are not of the same names: the plan changed since.
    """
    if set(stored) != set(found):
        odd = sorted(set(stored) ^ set(found))
        raise RatiosError(
            f"the stored ratios are of another plan ({', '.join(odd)}): record them anew with "
            "'python -m blender_tests.bench --quick --record'"
        )
    verdicts = [Verdict(name, stored[name], found[name]) for name in stored]
    return sorted(verdicts, key=lambda one: one.margin - one.change)
