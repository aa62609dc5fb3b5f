# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks node trees: what is in a tree and its groups, and what feeds a socket or a surface."""

from collections import deque
from collections.abc import Iterator

import bpy

from ..core.kinds import KINDS

# On a node group: which kind of material it is. It marks the group as ours.
KIND_KEY = "microbounce_kind"

# The group nodes around a node, from the outermost to the innermost.
Path = tuple[bpy.types.Node, ...]

_NAMES = frozenset(kind.name for kind in KINDS.values())


def is_our_group(group: bpy.types.NodeTree) -> bool:
    """Return whether `group` is one of ours, even if its library is missing.

    Blender keeps nothing but the name of a group whose library is missing.
    """
    if group.is_missing:
        return group.name.split(".")[0] in _NAMES
    return KIND_KEY in group


def node_kind(node: bpy.types.Node) -> str:
    """Return the kind of one of our group nodes, "" for any other node."""
    group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
    kind = group.get(KIND_KEY, "") if group is not None else ""
    return kind if kind in KINDS else ""


def surface_materials() -> list[bpy.types.Material]:
    """Return the file's materials without those of grease pencil, which have no surface."""
    return [material for material in bpy.data.materials if not material.is_grease_pencil]


def surface_tree(material: bpy.types.Material) -> bpy.types.ShaderNodeTree | None:
    """Return the node tree that renders `material`, None if it renders without nodes."""
    # From Blender 5 on nodes are always on, and the property is deprecated.
    on = bpy.app.version >= (5, 0, 0) or material.use_nodes
    return material.node_tree if on else None


def group_nodes(tree: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """Return the nodes of `tree` that show a node group."""
    return [node for node in tree.nodes if getattr(node, "node_tree", None) is not None]


def trees_within(*roots: bpy.types.NodeTree, muted: bool = True) -> list[bpy.types.NodeTree]:
    """Return `roots` and the node groups inside them, each once, the nearest first.

    Our own groups are left out, and without `muted` so are those of muted nodes.
    """
    found = dict.fromkeys(roots)
    waiting = deque(roots)
    while waiting:
        for node in group_nodes(waiting.popleft()):
            group = node.node_tree
            if group not in found and not is_our_group(group) and (muted or not node.mute):
                found[group] = None
                waiting.append(group)
    return list(found)


def our_nodes(tree: bpy.types.NodeTree, muted: bool = False) -> Iterator[bpy.types.Node]:
    """Yield our group nodes in `tree` and the groups inside it; muted ones only on request."""
    for each in trees_within(tree, muted=muted):
        for node in group_nodes(each):
            if is_our_group(node.node_tree) and (muted or not node.mute):
                yield node


def _group_output(group: bpy.types.NodeTree) -> bpy.types.Node | None:
    """Return the node that gives the outputs of a group."""
    ends = [node for node in group.nodes if node.bl_idname == "NodeGroupOutput"]
    return next((node for node in ends if node.is_active_output), None)


def socket_named(
    sockets: bpy.types.bpy_prop_collection, identifier: str
) -> bpy.types.NodeSocket | None:
    """Return the socket with this identifier; several may share a name."""
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def linked_output(socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """Return the output that is linked to an input, None without a link that counts."""
    links = (link for link in socket.links if link.is_valid and not link.is_muted)
    return next((link.from_socket for link in links), None)


def passes_on(node: bpy.types.Node) -> bool:
    """Return whether a node only hands on what comes in: a reroute, a group, a muted node."""
    if node.mute or node.bl_idname in ("NodeReroute", "NodeGroupInput"):
        return True
    group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
    return node.bl_idname == "ShaderNodeGroup" and (group is None or not is_our_group(group))


def input_behind(
    output: bpy.types.NodeSocket, path: Path
) -> tuple[bpy.types.NodeSocket, Path] | None:
    """Return the input, and its path, that the node of `output` hands on; None if there is none.

    The node passes_on(); `path` leads to it.
    """
    node = output.node
    if node.mute:
        inner = (link.from_socket for link in node.internal_links if link.to_socket == output)
    elif node.bl_idname == "NodeReroute":
        inner = iter(node.inputs)
    elif node.bl_idname == "NodeGroupInput":
        inner = iter([socket_named(path[-1].inputs, output.identifier)] if path else [])
        path = path[:-1]
    else:
        end = _group_output(node.node_tree) if node.node_tree is not None else None
        inner = iter([socket_named(end.inputs, output.identifier)] if end is not None else [])
        path = (*path, node)
    socket = next(inner, None)
    return (socket, path) if socket is not None else None


def reached_nodes(
    tree: bpy.types.ShaderNodeTree | None,
) -> Iterator[tuple[Path, bpy.types.Node]]:
    """Yield the nodes whose closures reach the surface that Cycles renders, the nearest first.

    Groups are entered, but not ours. Muted nodes are yielded too.
    """
    output = tree.get_output_node("CYCLES") if tree is not None else None
    if output is None:
        return
    waiting: deque[tuple[bpy.types.NodeSocket, Path]] = deque([(output.inputs["Surface"], ())])
    seen = set()
    while waiting:
        socket, path = waiting.popleft()
        source = linked_output(socket)
        if source is None:
            continue
        node = source.node
        on = passes_on(node)
        # A node that passes on may do so by several outputs.
        key = (*(group.as_pointer() for group in path), (source if on else node).as_pointer())
        if key in seen:
            continue
        seen.add(key)
        if not on or node.mute:
            yield path, node
        if on:
            behind = input_behind(source, path)
            waiting += [behind] if behind is not None else []
        else:
            waiting += [(one, path) for one in node.inputs if one.type == "SHADER"]
