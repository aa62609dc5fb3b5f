# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets the values of a preset on a material's node, or gives the material such a node."""

from collections.abc import Iterator, Mapping

import bpy

from ..core.kinds import KINDS, kind_named
from ..core.parameter import Value
from ..core.presets import Finish, Preset
from .group import KIND_KEY, add_group_node, material_group, new_material
from .sockets import socket_value

# On a node: the identifier of the preset that was last applied to it.
PRESET_KEY = "microbounce_preset"

# A node that is made for a preset starts with these, so that it looks as on the preset's picture;
# the group's own default of 0.5 would frost every glass.
NEW_VALUES: dict[str, dict[str, Value]] = {
    "CONDUCTOR": {"Roughness": 0.3},
    "DIELECTRIC": {"Roughness": 0.0},
    "DIFFUSE": {},
}


class ApplyError(ValueError):
    """Values that cannot be applied here; the message names the remedy, nothing was changed."""


def node_kind(node: bpy.types.Node) -> str:
    """Return the kind of one of our group nodes, "" for any other node."""
    group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
    kind = group.get(KIND_KEY, "") if group is not None else ""
    return kind if kind in KINDS else ""


def material_node(material: bpy.types.Material | None, kind: str = "") -> bpy.types.Node | None:
    """Return the node of ours that feeds the material's active output, None where none does.

    Of several it is the active one, else a selected one, else the nearest to the output; `kind`
    leaves out those of other kinds.
    """
    tree = material.node_tree if material is not None else None
    if tree is None:
        return None
    found = [node for node in _feeding(tree) if node_kind(node) and kind in ("", node_kind(node))]
    if tree.nodes.active in found:
        return tree.nodes.active
    return next((node for node in found if node.select), found[0] if found else None)


def obstacle(material: bpy.types.Material) -> str:
    """Return why the nodes of `material` cannot be changed, with the remedy; "" where they can."""
    if not material.is_editable:
        return f"The material '{material.name}' is linked from a library: make it local"
    if material.override_library is not None:
        return f"The material '{material.name}' is a library override: make it local"
    if material.is_grease_pencil:
        return f"'{material.name}' is a grease pencil material, which has no surface: add another"
    return ""


def apply_values(node: bpy.types.Node, values: Mapping[str, object]) -> list[str]:
    """Set parameters by identifier on one of our nodes; the node's other values stay.

    Returns the labels of those that were left, since they are linked or the node, which is of
    another version, has no such socket. Raises ApplyError, before anything is set, for a parameter
    that the node's kind does not have, and TypeError or ValueError for a bad value.
    """
    kind = kind_named(node_kind(node))
    wanted = []
    for identifier, value in values.items():
        parameter = kind.by_identifier.get(identifier)
        if parameter is None:
            raise ApplyError(
                f"{kind.name} has no {identifier!r}: use one of {', '.join(kind.by_identifier)}"
            )
        wanted.append((parameter.label, socket_value(parameter, value)))
    left = []
    for label, value in wanted:
        socket = node.inputs.get(label)
        if socket is None or socket.is_linked:
            left.append(label)
        else:
            socket.default_value = value
    return left


def apply_preset(
    material: bpy.types.Material, preset: Preset, finish: Finish | None = None
) -> list[str]:
    """Give `material` the values of `preset`, then those of `finish`; return what was left.

    What is left are the labels that apply_values() returns. Where no node of the preset's kind
    feeds the active output, a new one is linked to it; the nodes that were there stay, unlinked.
    Raises ApplyError for a material that cannot be changed or a finish for other kinds, and what
    material_group() raises.
    """
    values = _joined(preset, finish)
    node = ensure_node(material, preset.kind)
    left = apply_values(node, values)
    node[PRESET_KEY] = preset.identifier
    return left


def preset_material(preset: Preset, finish: Finish | None = None) -> bpy.types.Material:
    """Return a new material named after `preset`, with its values and those of `finish`.

    Raises what apply_preset() raises; no material is left behind then.
    """
    values = {**NEW_VALUES[preset.kind], **_joined(preset, finish)}
    material = new_material(preset.kind, preset.name, **values)
    material_node(material)[PRESET_KEY] = preset.identifier
    return material


def apply_finish(material: bpy.types.Material, finish: Finish) -> list[str]:
    """Set the values of `finish` on the material's node; return the labels that were left.

    Raises ApplyError where the material cannot be changed or has no node that takes the finish.
    """
    reason = obstacle(material)
    if reason:
        raise ApplyError(reason)
    node = material_node(material)
    if node is None or node_kind(node) not in finish.kinds:
        raise ApplyError(
            f"The finish '{finish.name}' needs a node {_names(finish.kinds)} that feeds the output "
            f"of '{material.name}': apply a preset of that kind first"
        )
    return apply_values(node, finish.values)


def ensure_node(material: bpy.types.Material, kind: str) -> bpy.types.Node:
    """Return material_node() of that kind, or a new one that is linked to the output.

    Raises ApplyError for a material that cannot be changed, and what material_group() raises.
    """
    reason = obstacle(material)
    if reason:
        raise ApplyError(reason)
    node = material_node(material, kind) or _linked_node(material, kind)
    if bpy.app.version < (5, 0, 0):  # later it is always on, and setting it is deprecated
        material.use_nodes = True
    return node


def _joined(preset: Preset, finish: Finish | None) -> dict[str, Value]:
    """Return the values of both, those of `finish` before the preset's."""
    if finish is None:
        return dict(preset.values)
    if preset.kind not in finish.kinds:
        raise ApplyError(
            f"The finish '{finish.name}' is for {_names(finish.kinds)}, and '{preset.name}' is "
            f"{KINDS[preset.kind].name}: choose another finish"
        )
    return {**preset.values, **finish.values}


def _names(kinds: tuple[str, ...]) -> str:
    return ", ".join(KINDS[kind].name for kind in kinds)


def _linked_node(material: bpy.types.Material, kind: str) -> bpy.types.Node:
    group = material_group(kind)
    if material.node_tree is None:  # before Blender 5
        material.use_nodes = True
        material.node_tree.nodes.clear()  # Blender's own, which nobody made
    tree = material.node_tree
    output = _output(tree)
    if output is None:
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        output.location = (300, 0)
        output.is_active_output = True
    occupied = output.inputs["Surface"].is_linked
    node = add_group_node(tree, group)
    x, y = output.location
    node.location = (x - 300, y + 600 if occupied else y)  # above what was linked
    apply_values(node, NEW_VALUES[kind])
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    for other in tree.nodes:
        other.select = other == node
    tree.nodes.active = node
    return node


def _output(tree: bpy.types.ShaderNodeTree) -> bpy.types.Node | None:
    return tree.get_output_node("CYCLES")


def _feeding(tree: bpy.types.ShaderNodeTree) -> Iterator[bpy.types.Node]:
    """Yield the nodes whose shaders reach the surface of the active output, nearest first."""
    output = _output(tree)
    if output is None:
        return
    sources: dict[bpy.types.Node, list[bpy.types.Node]] = {}
    for link in tree.links:
        surface = link.to_node != output or link.to_socket.identifier == "Surface"
        if surface and not link.is_muted:
            sources.setdefault(link.to_node, []).append(link.from_node)
    waiting, seen = [output], {output}
    while waiting:
        for node in sources.get(waiting.pop(0), ()):
            if node not in seen:
                seen.add(node)
                waiting.append(node)
                yield node
