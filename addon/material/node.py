# SPDX-License-Identifier: GPL-3.0-or-later
"""Our node in a material: finds it, adds it, and sets its values."""

from collections.abc import Mapping

import bpy

from ..core.kinds import Kind, kind_named
from .graph import node_kind, reached_nodes
from .group import add_group_node, material_group
from .sockets import socket_value


class MaterialError(ValueError):
    """This material cannot take the values; the message names the remedy. Nothing was changed."""


def why_not_editable(material: bpy.types.Material) -> str:
    """Return why the nodes of `material` cannot be changed, with the remedy; "" if they can."""
    if not material.is_editable or material.library is not None:
        return f"The material '{material.name}' is linked from a library: make it local"
    if material.override_library is not None:
        return f"The material '{material.name}' is a library override: make it local"
    if material.is_grease_pencil:
        return f"'{material.name}' is a grease pencil material, which has no surface: use another"
    return ""


def material_node(material: bpy.types.Material | None, kind: str = "") -> bpy.types.Node | None:
    """Return our node that feeds the surface of `material`, None if there is none.

    The active node comes first, then a selected one, then the nearest to the output. `kind` limits
    the search to one kind. Nodes inside groups do not count.
    """
    tree = material.node_tree if material is not None else None
    kinds = ((node, node_kind(node)) for path, node in reached_nodes(tree) if not path)
    found = [node for node, own in kinds if own and kind in ("", own)]
    if tree is not None and tree.nodes.active in found:
        return tree.nodes.active
    return next((node for node in found if node.select), found[0] if found else None)


def new_material(kind: str, name: str, **values: object) -> bpy.types.Material:
    """Return a new material `name` that holds one node of `kind` and an output.

    `values` are parameters by identifier, such as BaseColor=(1, 0.8, 0.4), Roughness=0.8 or
    Quality="Exact". Raises TypeError or ValueError for an unknown kind or parameter or a bad value,
    and what material_group() raises. No material is left behind then.
    """
    if not isinstance(name, str):
        raise TypeError(f"The material's name is {name!r}: give a text")
    _checked(kind_named(kind), values)
    material_group(kind)
    material = bpy.data.materials.new(name)
    add_surface_node(material, kind, values, keep=False)
    return material


def add_surface_node(
    material: bpy.types.Material, kind: str, values: Mapping[str, object], keep: bool = True
) -> bpy.types.Node:
    """Return a new node of `kind` with these values, linked to the output of `material`.

    With `keep` the nodes that are there stay, unlinked. Raises MaterialError if the material cannot
    change, and what set_values() and material_group() raise.
    """
    reason = why_not_editable(material)
    if reason:
        raise MaterialError(reason)
    group = material_group(kind)
    if bpy.app.version < (5, 0, 0):  # later nodes are always on, and setting it is deprecated
        keep = keep and material.node_tree is not None  # Blender fills a new tree with its own
        material.use_nodes = True
    tree = material.node_tree
    if not keep:
        tree.nodes.clear()
    output = tree.get_output_node("CYCLES")
    if output is None:
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        output.location = (300, 0)
        output.is_active_output = True
    node = add_group_node(tree, group)
    x, y = output.location
    # Above what was linked.
    node.location = (x - 300, y + 600 if output.inputs["Surface"].is_linked else y)
    set_values(node, values)
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    for other in tree.nodes:
        other.select = other == node
    tree.nodes.active = node
    return node


def set_values(node: bpy.types.Node, values: Mapping[str, object]) -> list[str]:
    """Set parameters of our node by identifier; return the labels that could not be set.

    An input cannot be set if it is linked, or if the node is of another version and lacks it.
    Raises TypeError for a parameter that the kind does not have, and TypeError or ValueError for a
    bad value. Nothing is set then.
    """
    left = []
    for label, value in _checked(kind_named(node_kind(node)), values).items():
        socket = node.inputs.get(label)
        if socket is None or socket.is_linked:
            left.append(label)
        else:
            socket.default_value = value
    return left


def _checked(kind: Kind, values: Mapping[str, object]) -> dict[str, object]:
    """Return the values as sockets take them, by label."""
    known = kind.by_identifier
    for identifier in values:
        if identifier not in known:
            raise TypeError(f"{kind.name} has no {identifier!r}: use one of {', '.join(known)}")
    return {known[i].label: socket_value(known[i], value) for i, value in values.items()}
