# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells which lights the quality Exact misses: its mirror closures find only what a path hits."""

from collections.abc import Iterable
from dataclasses import dataclass

# What the size of each kind of light is called in Blender.
_SIZE = {"SUN": "angle", "POINT": "radius", "SPOT": "radius", "AREA": "size"}

# As many names fit into a panel; the rest is counted.
_MOST_NAMES = 4


@dataclass(frozen=True)
class Lamp:
    """A light object that shines in the render.

    kind                -- "SUN", "POINT", "SPOT" or "AREA"
    size                -- a sun's angle in radians, another light's radius or smaller side
    multiple_importance -- Cycles' switch: without it a path goes through the light
    """

    name: str
    kind: str
    size: float
    multiple_importance: bool = True

    @property
    def why_missed(self) -> str:
        """Return why no path can hit it, "" if one can."""
        if self.size <= 0.0:
            return f"{_SIZE[self.kind]} 0"
        if not self.multiple_importance:
            return "Multiple Importance off"
        return ""


def exact_warning(lamps: Iterable[Lamp]) -> str:
    """Return which of `lamps` do not light a material of quality Exact, and the remedy.

    Returns "" if it finds all of them.
    """
    missed = [lamp for lamp in lamps if lamp.why_missed]
    if not missed:
        return ""
    names = [f"'{lamp.name}' ({lamp.why_missed})" for lamp in missed[:_MOST_NAMES]]
    if len(missed) > _MOST_NAMES:
        names.append(f"{len(missed) - _MOST_NAMES} more")
    remedies = ["set Quality to Walk"]
    if any(lamp.size <= 0.0 for lamp in missed):
        remedies.append("give them a size")
    if any(not lamp.multiple_importance for lamp in missed):
        remedies.append("switch their Multiple Importance on")
    return (
        "Quality Exact finds lights only by hitting them and is black under "
        f"{', '.join(names)}. Remedy: {' or '.join(remedies)}."
    )
