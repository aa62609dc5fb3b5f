# SPDX-License-Identifier: GPL-3.0-or-later
"""Replaces node groups that older versions left in the file by today's."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import bpy

from ..core.kinds import KINDS
from .animation import Curves, input_curves, move_curves
from .graph import KIND_KEY, group_nodes
from .group import VERSION_KEY, material_group, script_node
from .sockets import SocketValue, plain_value, value_text
from .versions import forget_stamps, is_newer, is_of_another_version


@dataclass
class Update:
    """What an update did, in words for users.

    nodes   -- how many nodes took a new group
    lost    -- values and links of inputs that the new group does not have
    stay    -- old nodes that could not be changed, and why
    removed -- names of the old groups that were removed
    """

    nodes: int = 0
    lost: list[str] = field(default_factory=list)
    stay: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)


def old_groups() -> list[bpy.types.NodeTree]:
    """Return the groups in the file that older versions made and that a node uses.

    Groups of newer versions and groups linked from libraries are left out. Raises
    ShaderSourceError if the installation is damaged.
    """
    found = [g for g in bpy.data.node_groups if g.users and not g.library and _is_old(g)]
    if not found:
        return []
    # An asset's fake user is no node to update.
    used = {node.node_tree for _, tree in _shader_trees() for node in group_nodes(tree)}
    return [group for group in found if group in used]


def update_materials() -> Update:
    """Replace old groups by today's, with the values and links of the same names.

    Works on everything that has shader nodes in the file. Old groups and their texts are removed if
    nothing uses them any more. Raises one of GROUP_ERRORS if a group cannot be made; nothing is
    changed then.
    """
    forget_stamps()  # the sources may have changed on disk
    done = Update()
    old = set(old_groups())
    new = {kind: material_group(kind) for kind in sorted({group[KIND_KEY] for group in old})}
    for owner, tree in _shader_trees():
        curves: dict[str, Curves] | None = None
        for node in group_nodes(tree):
            reason = _why_not_updatable(owner, node)
            if reason:
                done.stay.append(f"{owner.name}, {node.name}: {reason}")
            elif node.node_tree in old:
                if curves is None:
                    curves = input_curves(tree)
                lost = _swap(tree, node, new[node.node_tree[KIND_KEY]], curves.get(node.name, {}))
                done.lost += [f"{owner.name}, {node.name}: {text}" for text in lost]
                done.nodes += 1
    done.removed = _remove_unused(old)
    for kind, group in new.items():
        _take_name(group, kind)
    return done


def _is_old(group: bpy.types.NodeTree) -> bool:
    return is_of_another_version(group) and not is_newer(group)


def _shader_trees() -> Iterator[tuple[bpy.types.ID, bpy.types.NodeTree]]:
    """Yield the node trees that may hold our nodes, with the data-blocks that own them."""
    for group in bpy.data.node_groups:
        if group.bl_idname == "ShaderNodeTree" and KIND_KEY not in group:
            yield group, group
    data = bpy.data
    for owners in (data.materials, data.worlds, data.lights, data.linestyles):
        for owner in owners:
            if owner.node_tree is not None:
                yield owner, owner.node_tree


def _why_not_updatable(owner: bpy.types.ID, node: bpy.types.Node) -> str:
    """Return why an old node cannot be changed, with the remedy; "" if it can or is not old."""
    group = node.node_tree
    if not is_of_another_version(group):
        return ""
    if is_newer(group):
        return f"its group is of version {group[VERSION_KEY]}: update the extension"
    if owner.library or not owner.is_editable:
        return "it is linked from a library: update it in its own file"
    if owner.override_library:
        return "it is a library override, whose nodes cannot change: update the library"
    if group.library:
        return f"its group is linked from '{group.library.filepath}': update it there"
    return ""


def _swap(
    tree: bpy.types.NodeTree, node: bpy.types.Node, new: bpy.types.NodeTree, curves: Curves
) -> list[str]:
    """Give `node` the group `new`; return what was lost.

    Inputs are matched by name. Blender itself matches them by identifier, which only counts the
    sockets of a group.
    """
    defaults = _defaults(node.node_tree)
    before = {socket.name: plain_value(socket.default_value) for socket in node.inputs}
    hidden = {socket.name for socket in node.inputs if socket.hide}
    sources = [(s.name, k.from_socket, k.is_muted) for s in node.inputs for k in s.links]
    targets = [(s.name, k.to_socket, k.is_muted) for s in node.outputs for k in s.links]
    for socket in (*node.inputs, *node.outputs):
        for link in list(socket.links):
            tree.links.remove(link)
    node.node_tree = new
    inputs = {socket.name: socket for socket in node.inputs}
    outputs = {socket.name: socket for socket in node.outputs}
    _set_values(inputs, before, _defaults(new))
    changed = [name for name, value in before.items() if value != defaults.get(name)]
    lost = [
        f"{name} was {value_text(before[name])}"
        for name in changed
        if name not in inputs or plain_value(inputs[name].default_value) != before[name]
    ]
    for name, socket in inputs.items():
        socket.hide = name in hidden
    for name, source, muted in sources:
        if name in inputs:
            tree.links.new(source, inputs[name]).is_muted = muted
        else:
            lost.append(f"{name} was linked to '{source.node.name}'")
    for name, target, muted in targets:
        if name in outputs:
            tree.links.new(outputs[name], target).is_muted = muted
        else:
            lost.append(f"the output {name} was linked to '{target.node.name}'")
    names = list(before)
    move_curves(curves, names, node, {name: name for name in inputs})
    gone = [names[number] for number in curves if number < len(names)]
    lost += [f"{name} was animated" for name in gone if name not in inputs]
    return lost


def _set_values(
    inputs: dict[str, bpy.types.NodeSocket],
    values: dict[str, SocketValue],
    defaults: dict[str, SocketValue],
) -> None:
    """Set each input to the value of its name, or to the group's default."""
    for name, socket in inputs.items():
        socket.default_value = defaults[name]
        if name in values:
            try:
                socket.default_value = values[name]
            except (TypeError, ValueError):  # the socket is of another type now
                continue


def _defaults(group: bpy.types.NodeTree) -> dict[str, SocketValue]:
    return {
        item.name: plain_value(item.default_value)
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.in_out == "INPUT"
    }


def _remove_unused(groups: set[bpy.types.NodeTree]) -> list[str]:
    """Remove the groups without users, and their texts; return the groups' names."""
    removed = []
    for group in groups:
        if group.users:
            continue
        script = script_node(group)
        text = script.script if script is not None else None
        removed.append(group.name)
        bpy.data.node_groups.remove(group)
        # Each text counts one user more, so that Blender keeps it.
        if text is not None and not text.library and text.users <= int(text.use_fake_user):
            bpy.data.texts.remove(text)
    return sorted(removed)


def _take_name(group: bpy.types.NodeTree, kind: str) -> None:
    """Give a new group and its text the names that old ones may have freed."""
    text = script_node(group).script
    wanted = ((bpy.data.node_groups, group, KINDS[kind].name),)
    if text is not None:
        wanted += ((bpy.data.texts, text, f"{KINDS[kind].shader}.osl"),)
    for collection, block, name in wanted:
        if name not in collection:
            block.name = name
