# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts a node in the place of another and removes that one."""

import bpy

from ..material.animation import Curves, move_curves
from .record import RECORD_KEY, Link
from .state import inputs_by_name
from .translation import Translation

# Properties of every node that stay as they are.
_LOOKS = (
    *("label", "mute", "hide", "select", "use_custom_color", "color"),
    *("show_options", "show_preview", "show_texture", "warning_propagation"),
)


def take_place(
    tree: bpy.types.NodeTree,
    old: bpy.types.Node,
    new: bpy.types.Node,
    made: Translation,
    links: list[Link],
    curves: Curves,
) -> None:
    """Give `new` the links, animation, looks, place and name of `old`, and remove `old`.

    `made` says where the links of each input of `old` go. Both nodes have an output BSDF. `links`
    are made too, if their nodes still exist. Links that `made` does not carry are lost.
    """
    was_active = tree.nodes.active == old
    inputs, targets = inputs_by_name(old), inputs_by_name(new)
    new.parent = old.parent
    new.location = old.location
    unused: list[bpy.types.Node] = []
    for name, other in made.carried.items():
        for link in inputs[name].links:
            source = link.from_socket
            if name in made.through:
                formula, undoes = made.through[name]
                source, inserted = undoes.inserted(source) or (formula.insert(source, new), [])
                unused += inserted
            _link(tree, source, targets[other], link.is_muted)
    for link in list(old.outputs["BSDF"].links):
        _link(tree, new.outputs["BSDF"], link.to_socket, link.is_muted)
    for link in links:
        source = source_of(tree, link)
        if source is not None and link.socket in targets:
            _link(tree, source, targets[link.socket], link.muted)
    for name in _LOOKS:
        setattr(new, name, getattr(old, name))
    for key, value in old.items():
        if key != RECORD_KEY:
            new[key] = value
    # Blender deletes a node's animation with the node, and renames it with the node.
    move_curves(curves, list(inputs), new, made.carried)
    name = old.name
    tree.nodes.remove(old)
    for node in unused:
        if not node.outputs[0].is_linked:
            tree.nodes.remove(node)
    new.name = name
    if was_active:
        tree.nodes.active = new


def lost_links(node: bpy.types.Node, carried: dict[str, str]) -> list[Link]:
    """Return the links into inputs of `node` that are not in `carried`."""
    return [
        Link(socket.name, link.from_node.name, link.from_socket.identifier, link.is_muted)
        for socket in node.inputs
        if socket.name not in carried
        for link in socket.links
    ]


def source_of(tree: bpy.types.NodeTree, link: Link) -> bpy.types.NodeSocket | None:
    """Return the output that `link` came from, None if it is gone."""
    node = tree.nodes.get(link.node)
    outputs = node.outputs if node is not None else ()
    return next((socket for socket in outputs if socket.identifier == link.output), None)


def _link(
    tree: bpy.types.NodeTree,
    source: bpy.types.NodeSocket,
    target: bpy.types.NodeSocket,
    muted: bool,
) -> None:
    link = tree.links.new(source, target)
    if muted:
        link.is_muted = True
