# SPDX-License-Identifier: GPL-3.0-or-later
"""Names the lights of the scene that the material shown misses in quality Exact."""

import bpy

from ..core.lamps import exact_warning
from ..scene.exact import enabled_lamps, uses_exact


def active_tree(context: bpy.types.Context) -> bpy.types.NodeTree | None:
    """Return the node tree in the node editor of `context`, elsewhere that of the material shown.

    Pinned trees and materials count; where no material is shown it is the active object's.
    """
    space = context.space_data
    if space is not None and space.type == "NODE_EDITOR":
        return space.node_tree
    # Only some tabs of the Properties editor have this.
    material = getattr(context, "material", None)
    if material is None and context.object is not None:
        material = context.object.active_material
    return material.node_tree if material is not None else None


def missed_lights(context: bpy.types.Context) -> str:
    """Return which lights the active tree misses because of quality Exact, with the remedy."""
    tree = active_tree(context)
    if tree is None or not uses_exact(tree):
        return ""
    return exact_warning(enabled_lamps(context.view_layer))
