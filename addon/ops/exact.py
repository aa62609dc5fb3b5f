# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds materials of quality Exact and the lights of a scene that such a material misses."""

from collections.abc import Iterator

import bpy

from ..core.kinds import KINDS
from ..core.lamps import Lamp, exact_warning
from ..nodes.group import STAMP_KEY

# One for all kinds.
_QUALITY = KINDS["CONDUCTOR"].by_identifier["Quality"]
_EXACT = _QUALITY.checked("Exact")


def active_tree(context: bpy.types.Context) -> bpy.types.NodeTree | None:
    """Return the node tree in the node editor of `context`, elsewhere that of the material shown.

    Pinned trees and materials count; where no material is shown it is the active object's.
    """
    space = context.space_data
    if space is not None and space.type == "NODE_EDITOR":
        return space.node_tree
    # Only the Properties editor has this one, and only in some of its tabs.
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


def uses_exact(tree: bpy.types.NodeTree) -> bool:
    """Return whether a node of ours in `tree`, or in a group within it, is set to Exact.

    A Quality that is linked is not followed.
    """
    trees, seen = [tree], {tree}
    while trees:
        for node in trees.pop().nodes:
            group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
            if group is None or node.mute:
                continue
            if STAMP_KEY in group:
                quality = node.inputs.get(_QUALITY.label)
                if quality and not quality.is_linked and quality.default_value == _EXACT:
                    return True
            elif group not in seen:
                seen.add(group)
                trees.append(group)
    return False


def enabled_lamps(view_layer: bpy.types.ViewLayer) -> list[Lamp]:
    """Return the lights that the layer renders, each once, also those in collection instances."""
    found: dict[bpy.types.Object, Lamp] = {}
    for obj in _rendered_objects(view_layer.layer_collection):
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


def _rendered_objects(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.Object]:
    if layer.collection.hide_render:
        return
    if not layer.exclude:  # what is below an excluded collection may still be included
        for obj in layer.collection.objects:
            yield from _with_instances(obj)
    for child in layer.children:
        yield from _rendered_objects(child)


def _with_instances(obj: bpy.types.Object) -> Iterator[bpy.types.Object]:
    if obj.hide_render:
        return
    yield obj
    if obj.instance_type == "COLLECTION" and obj.instance_collection:
        yield from _instanced(obj.instance_collection)


def _instanced(collection: bpy.types.Collection) -> Iterator[bpy.types.Object]:
    if collection.hide_render:
        return
    for obj in collection.objects:
        yield from _with_instances(obj)
    for child in collection.children:
        yield from _instanced(child)
