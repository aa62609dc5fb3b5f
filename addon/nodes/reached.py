# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the nodes whose closures reach the surface of a material, also within node groups."""

from collections.abc import Iterator

import bpy

from .find import is_ours, surface_tree
from .ranges import Path, group_output


def surface_output(material: bpy.types.Material) -> bpy.types.Node | None:
    """Return the material's active output for Cycles, None where it renders by no nodes."""
    tree = surface_tree(material)
    return tree.get_output_node("CYCLES") if tree is not None else None


def reached_nodes(material: bpy.types.Material) -> Iterator[tuple[Path, bpy.types.Node]]:
    """Yield each node that is not muted and reaches the surface, and the groups in which it lies.

    Groups are entered, but not ours.
    """
    output = surface_output(material)
    if output is None:
        return
    waiting: list[tuple[Path, bpy.types.Node]] = [
        ((), one) for one in _linked([output.inputs["Surface"]])
    ]
    seen = set()
    while waiting:
        path, node = waiting.pop()
        key = (*(one.as_pointer() for one in path), node.as_pointer())
        if key in seen:
            continue
        seen.add(key)
        group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
        if group is not None and not node.mute and not is_ours(group):
            end = group_output(group)
            waiting += [((*path, node), end)] if end else []
            continue
        if not node.mute:
            yield path, node
        if node.bl_idname == "NodeGroupInput" and path:
            waiting += [(path[:-1], one) for one in _linked(path[-1].inputs)]
        waiting += [(path, one) for one in _linked(node.inputs)]


def _linked(sockets: list[bpy.types.NodeSocket]) -> list[bpy.types.Node]:
    return [
        link.from_node
        for socket in sockets
        if socket.type == "SHADER" or socket.node.bl_idname == "NodeReroute"
        for link in socket.links
        if link.is_valid and not link.is_muted
    ]
