# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that a scene renders, collection instances included, and their materials."""

from collections.abc import Iterator

import bpy

from ..material.graph import trees_within

_SOCKET = "NodeSocketMaterial"


def rendered_objects(view_layer: bpy.types.ViewLayer) -> Iterator[bpy.types.Object]:
    """Yield the objects that the layer renders. One with several users may come twice."""
    if view_layer.layer_collection is None:  # Blender 5.2, in a scene that was never shown
        yield from _instanced(view_layer.id_data.collection)
    else:
        yield from _in_layer(view_layer.layer_collection)


def rendered_materials(scene: bpy.types.Scene) -> list[bpy.types.Material]:
    """Return the materials on the objects that the scene's view layers render, each once.

    Materials that geometry nodes set are among them if a modifier, or a group that it uses, names
    them.
    """
    materials: dict[bpy.types.Material | None, None] = {}
    objects = {o: None for layer in scene.view_layers if layer.use for o in rendered_objects(layer)}
    trees: dict[bpy.types.NodeTree, None] = {}
    for obj in objects:
        for slot in obj.material_slots:
            materials[slot.material] = None
        for modifier in obj.modifiers:
            if modifier.type == "NODES" and modifier.show_render and modifier.node_group:
                trees[modifier.node_group] = None
                materials |= dict.fromkeys(_inputs(modifier))
    for tree in trees_within(*trees):
        for node in tree.nodes:
            sockets = (s for s in node.inputs if s.bl_idname == _SOCKET)
            materials |= {socket.default_value: None for socket in sockets}
    materials.pop(None, None)
    return list(materials)


def _inputs(modifier: bpy.types.NodesModifier) -> Iterator[bpy.types.Material | None]:
    """Yield the materials that a modifier hands to its node group."""
    for item in modifier.node_group.interface.items_tree:
        if item.item_type != "SOCKET" or (item.in_out, item.socket_type) != ("INPUT", _SOCKET):
            continue
        if hasattr(modifier, "properties"):  # Blender 5.2
            yield getattr(modifier.properties.inputs, item.identifier).value
        else:
            yield modifier.get(item.identifier)


def _in_layer(layer: bpy.types.LayerCollection) -> Iterator[bpy.types.Object]:
    if layer.collection.hide_render:
        return
    if not layer.exclude:  # a collection inside an excluded one may still be included
        for obj in layer.collection.objects:
            yield from _with_instances(obj)
    for child in layer.children:
        yield from _in_layer(child)


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
