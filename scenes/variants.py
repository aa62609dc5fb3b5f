# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches our materials of an open scene between the qualities and Cycles' own closures."""

from dataclasses import dataclass

import bpy

from addon.core.kinds import Kind, kind_named
from addon.nodes.fallback import MATTE_ROUGHNESS
from addon.nodes.group import KIND_KEY, has_bytecode

CYCLES_OWN = "Cycles"
_NATIVE = {
    "CONDUCTOR": "ShaderNodeBsdfMetallic",
    "DIELECTRIC": "ShaderNodeBsdfGlass",
    "DIFFUSE": "ShaderNodeBsdfDiffuse",
}
# The parameters that a native node has as well. Of a metal's, `fresnel_type` shows two more.
_SHARED = {
    "CONDUCTOR": ("Roughness", "Anisotropy", "Rotation", "Normal", "Tangent"),
    "DIELECTRIC": ("Color", "IOR", "Roughness", "Normal"),
    "DIFFUSE": ("Color", "Normal"),
}
_METAL_COLOR = {"F82": ("BaseColor", "EdgeTint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}


@dataclass(frozen=True)
class Material:
    """A material that is made of one of our node groups, and the object index that shows it."""

    name: str
    index: int
    material: bpy.types.Material

    @property
    def node(self) -> bpy.types.ShaderNodeGroup:
        """The node of the group in the material."""
        return next(node for node in self.material.node_tree.nodes if is_ours(node))

    @property
    def kind(self) -> Kind:
        """What it is made of."""
        return kind_named(self.node.node_tree[KIND_KEY])

    def set(self, identifier: str, value: object) -> None:
        """Set an unlinked parameter by its identifier; raises what Parameter.checked() raises."""
        parameter = self.kind.by_identifier[identifier]
        checked = parameter.checked(value)
        if parameter.kind == "COLOR":
            checked = (*checked, 1.0)
        self.node.inputs[parameter.label].default_value = checked

    def get(self, identifier: str) -> object:
        """Return an unlinked parameter's value: a number, or a list of three or four."""
        value = self.node.inputs[self.kind.by_identifier[identifier].label].default_value
        return list(value) if hasattr(value, "__len__") else value


def is_ours(node: bpy.types.Node) -> bool:
    """Return whether this is a node of one of our groups."""
    return (
        node.bl_idname == "ShaderNodeGroup"
        and node.node_tree is not None
        and KIND_KEY in node.node_tree
    )


def find_materials() -> list[Material]:
    """Return our materials of the open file, of any kind, by rising object index.

    Raises RuntimeError where there is none, or where one of them holds no compiled shader.
    """
    found = {}
    for thing in bpy.context.scene.objects:
        for slot in thing.material_slots:
            tree = slot.material.node_tree if slot.material else None
            if tree and any(is_ours(node) for node in tree.nodes):
                name = slot.material.name
                found[name] = Material(name, thing.pass_index, slot.material)
    if not found:
        raise RuntimeError(
            f"{bpy.data.filepath} holds no material of ours: build it anew with 'make scenes'"
        )
    for material in found.values():
        if not has_bytecode(material.node.node_tree):
            raise RuntimeError(
                f"{material.name} holds no compiled shader: build the file anew with 'make scenes'"
            )
    return sorted(found.values(), key=lambda material: material.index)


def use_quality(materials: list[Material], quality: str) -> None:
    """Show the materials with Microbounce at this quality ("Single", "Walk" ...)."""
    for material in materials:
        material.set("Quality", quality)
        _show(material.material, material.node)


def use_cycles_multiscatter(materials: list[Material]) -> None:
    """Show the materials with Cycles' own closure of the same values.

    GGX takes Multiscatter GGX. For Beckmann Cycles has one bounce and nothing else. Cycles' glass
    and matte surface have no anisotropy, and the latter takes a part of the roughness.
    """
    for material in materials:
        kind = material.kind.identifier
        tree = material.material.node_tree
        native = tree.nodes.get(CYCLES_OWN)
        if native is None:
            native = tree.nodes.new(_NATIVE[kind])
            native.name = native.label = CYCLES_OWN
            native.location = (0, -500)
        shared = _SHARED[kind]
        if kind == "CONDUCTOR":
            native.fresnel_type = "PHYSICAL_CONDUCTOR" if material.get("Fresnel") else "F82"
            shared += _METAL_COLOR[native.fresnel_type]
        if kind == "DIFFUSE":
            roughness = MATTE_ROUGHNESS * material.get("Roughness")
            native.inputs["Roughness"].default_value = roughness
        else:
            native.distribution = "BECKMANN" if material.get("Distribution") else "MULTI_GGX"
        for identifier in shared:
            label = material.kind.by_identifier[identifier].label
            source = material.node.inputs[label]
            if source.is_linked:
                tree.links.new(source.links[0].from_socket, native.inputs[label])
            else:
                native.inputs[label].default_value = source.default_value
        _show(material.material, native)


def _show(material: bpy.types.Material, node: bpy.types.Node) -> None:
    output = material.node_tree.get_output_node("CYCLES")
    material.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
