# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the time ratios of a quick run with stored ones: what got slower, and by how much.

Seconds differ between machines. Ratios of two variants of one scene differ far less. Other work on
the machine takes cache and shares cores, so it can only add to a processor time. Each variant
therefore counts with the least of its rounds: load changes that far less than the median.

The margin is three times the measured error of both ratios. The error of a least time is about its
distance from the second least: the two are equal in the mean if times fall off exponentially above
a floor. The margin is at least SMALLEST_MARGIN, because processors differ. It is at most
LARGEST_MARGIN, so noise hides no larger slowdown.
"""

import json
import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from .curves import Curve
from .findings import SceneFindings
from .plan import CYCLES, CYCLES_SVM, EXACT, FITTED, ONE_WALK, SINGLE, WALK

SMALLEST_MARGIN, LARGEST_MARGIN = 0.15, 0.25
DEVIATIONS = 3.0
# Multiples of the plan's rounds. A scene that looks slower after the first is measured on.
REPEATS = (1, 3)
# The same for stored ratios. They have more rounds because all later checks rest on them.
RECORDED = 2
_REMEDY = "record them with 'python -m tools.bench --quick --record'"

# The compared ratios: scene, variant, and the variant that its time is divided by.
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
    """The stored ratios are missing or wrong. The message has the remedy."""


@dataclass(frozen=True)
class Ratio:
    """A ratio of least times, and its relative error."""

    value: float
    error: float


def ratio(ours: Curve, theirs: Curve) -> Ratio:
    """How many times as long a sample of `ours` takes. Both curves need two rounds or more."""
    (mine, next_mine, *_), (other, next_other, *_) = sorted(ours.cpu), sorted(theirs.cpu)
    return Ratio(mine / other, math.hypot(next_mine / mine - 1.0, next_other / other - 1.0))


def ratios(found: Mapping[str, SceneFindings]) -> dict[str, Ratio]:
    """The ratios of CHECKED by name. Raises KeyError if a scene or variant was not measured."""
    return {
        _name(scene, ours, theirs): ratio(found[scene].curves[ours], found[scene].curves[theirs])
        for scene, ours, theirs in CHECKED
    }


def write_ratios(found: Mapping[str, Ratio], machine: Mapping[str, object]) -> str:
    """The text of ratios.json."""
    stored = {name: {key: round(value, 5) for key, value in asdict(one).items()}
              for name, one in found.items()}  # fmt: skip
    content = {"command": "make bench", "machine": dict(machine), "ratios": stored}
    return json.dumps(content, indent=2) + "\n"


def read_ratios(path: Path, blender: str) -> dict[str, Ratio]:
    """Stored ratios by name. Raises RatiosError.

    blender -- a version such as "5.2.3". The ratios must have the same first two numbers.
    """
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
        theirs = str(stored["machine"]["blender"])
        found = {
            name: Ratio(float(one["value"]), float(one["error"]))
            for name, one in stored["ratios"].items()
        }
    except OSError as error:
        raise RatiosError(f"{path.name} cannot be read ({error.strerror}): {_REMEDY}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RatiosError(f"{path.name} holds no ratios ({error!r}): {_REMEDY}") from error
    if theirs.split(".")[:2] != blender.split(".")[:2]:
        raise RatiosError(
            f"{path.name} was recorded with Blender {theirs}, this is {blender}: check with that "
            f"version, or {_REMEDY}"
        )
    bad = [
        name
        for name, one in found.items()
        if not (0.0 < one.value < math.inf and 0.0 <= one.error < math.inf)
    ]
    if bad:
        raise RatiosError(f"{path.name} has no positive ratio of {', '.join(bad)}: {_REMEDY}")
    odd = sorted(set(found) ^ {_name(*what) for what in CHECKED})
    if odd:
        raise RatiosError(f"{path.name} is of another plan ({', '.join(odd)}): {_REMEDY}")
    return found


@dataclass(frozen=True)
class Growth:
    """How much one ratio grew over the stored one."""

    name: str
    stored: Ratio
    found: Ratio

    @property
    def change(self) -> float:
        """Relative change: 0.2 for a ratio that grew by a fifth, negative if it fell."""
        return self.found.value / self.stored.value - 1.0

    @property
    def margin(self) -> float:
        """The largest change that is allowed."""
        noise = DEVIATIONS * math.hypot(self.stored.error, self.found.error)
        return min(max(SMALLEST_MARGIN, noise), LARGEST_MARGIN)

    @property
    def scene(self) -> str:
        """The name of the scene in the quick plan."""
        return self.name.partition(":")[0]

    @property
    def slower(self) -> bool:
        """Whether it grew by more than the margin."""
        return self.change > self.margin

    def __str__(self) -> str:
        word = "slower" if self.change > 0 else "faster"
        return (
            f"{self.name} is {self.found.value:.2f}, stored {self.stored.value:.2f}: "
            f"{abs(self.change):.0%} {word} (margin {self.margin:.0%})"
        )


def compare(stored: Mapping[str, Ratio], found: Mapping[str, Ratio]) -> list[Growth]:
    """The growth of every stored ratio, the worst first."""
    growths = [Growth(name, stored[name], found[name]) for name in stored]
    return sorted(growths, key=lambda one: one.margin - one.change)


def settled(
    stored: Mapping[str, Ratio],
    measured: Callable[[Collection[str], int], Mapping[str, SceneFindings]],
) -> list[Growth]:
    """`compare`, after more rounds of the scenes that look slower.

    measured -- returns the findings of the named scenes, with a multiple of the quick plan's rounds
    """
    found: dict[str, SceneFindings] = {}
    names = {scene for scene, _, _ in CHECKED}
    for times in REPEATS:
        found |= measured(names, times)
        growths = compare(stored, ratios(found))
        names = {growth.scene for growth in growths if growth.slower}
        if not names:
            break
    return growths


def _name(scene: str, ours: str, theirs: str) -> str:
    return f"{scene}: {ours} / {theirs}"
