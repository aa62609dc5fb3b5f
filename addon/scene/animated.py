# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the values that animation gives to the properties of a node tree."""

from itertools import pairwise

import bpy

from ..core.intervals import ANYTHING, Interval, hull
from ..material.animation import animation_curves

# Other interpolations swing beyond their keys.
_WITHIN_KEYS = {"CONSTANT", "LINEAR", "BEZIER"}

# Ranges of values, by the property's path in the tree and the number of the component.
Animated = dict[tuple[str, int], Interval]


def animated_values(tree: bpy.types.NodeTree) -> Animated:
    """Return the ranges of all values that curves and drivers give, at any frame.

    A driver can give any value. So can an NLA strip, and a curve that leaves the range of its keys.
    """
    data = tree.animation_data
    found: Animated = {}
    for curve in animation_curves(data):
        plain = curve.driver is None and not data.nla_tracks
        key = (curve.data_path, curve.array_index)
        one = _curve_range(curve) if plain else ANYTHING
        found[key] = hull((one, found.get(key, one)))
    return found


def _curve_range(curve: bpy.types.FCurve) -> Interval:
    """Return the range of a curve: a Bezier lies within its keys and handles."""
    keys = list(curve.keyframe_points)
    if (
        not keys
        or len(curve.modifiers)
        or curve.extrapolation != "CONSTANT"
        or any(key.interpolation not in _WITHIN_KEYS for key in keys)
    ):
        return ANYTHING
    values = [key.co.y for key in keys]
    for key, after in pairwise(keys):
        if key.interpolation == "BEZIER":
            values += [key.handle_right.y, after.handle_left.y]
    return min(values), max(values)
