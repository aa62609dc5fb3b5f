# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds node trees set to Exact, and the lights that Exact has to hit."""

import bpy

from ..core.lamps import Lamp
from ..core.parameters import SHARED
from ..material.graph import our_nodes
from .rendered import rendered_objects

_QUALITY = SHARED["Quality"]
_EXACT = _QUALITY.checked("Exact")


def uses_exact(tree: bpy.types.NodeTree) -> bool:
    """Return whether a node of ours in `tree`, or in a group within it, is set to Exact."""
    return any(map(is_exact, our_nodes(tree)))


def is_exact(node: bpy.types.ShaderNodeGroup) -> bool:
    """Return whether a node of ours is set to Exact. Links to Quality are not followed."""
    quality = node.inputs.get(_QUALITY.label)
    return bool(quality and not quality.is_linked and quality.default_value == _EXACT)


def enabled_lamps(view_layer: bpy.types.ViewLayer) -> list[Lamp]:
    """Return the lights that the layer renders, each once, collection instances included."""
    found: dict[bpy.types.Object, Lamp] = {}
    for obj in rendered_objects(view_layer):
        if obj.type == "LIGHT" and obj.data.energy != 0.0 and not obj.data.cycles.is_portal:
            found[obj] = _lamp(obj)
    return list(found.values())


def _lamp(obj: bpy.types.Object) -> Lamp:
    light = obj.data
    if light.type == "SUN":
        size = light.angle
    elif light.type == "AREA":
        oblong = light.shape in ("RECTANGLE", "ELLIPSE")
        size = min(light.size, light.size_y) if oblong else light.size
    else:
        size = light.shadow_soft_size
    return Lamp(obj.name, light.type, size, light.cycles.use_multiple_importance_sampling)
