# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches the metals of an open scene between Microbounce's qualities and Cycles' own metal."""

from dataclasses import dataclass

import bpy

from addon.core.parameters import CONDUCTOR
from addon.nodes.conductor import GROUP_NAME, has_bytecode

CYCLES_METAL = "Cycles Metal"
_BY_IDENTIFIER = {parameter.identifier: parameter for parameter in CONDUCTOR}
# The inputs that Cycles' Metallic BSDF and the group share, of which `fresnel_type` shows two.
_SURFACE = ("Roughness", "Anisotropy", "Rotation", "Normal", "Tangent")
_COLOR = {"F82": ("BaseColor", "EdgeTint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}


@dataclass(frozen=True)
class Metal:
    """A material that is made of the conductor's node group, and the object index that shows it."""

    name: str
    index: int
    material: bpy.types.Material

    @property
    def node(self) -> bpy.types.ShaderNodeGroup:
        """The node of the group in the material."""
        return next(node for node in self.material.node_tree.nodes if is_conductor(node))

    def set(self, identifier: str, value: object) -> None:
        """Set an unlinked parameter by its identifier; raises what Parameter.checked() raises."""
        parameter = _BY_IDENTIFIER[identifier]
        checked = parameter.checked(value)
        if parameter.kind == "COLOR":
            checked = (*checked, 1.0)
        self.node.inputs[parameter.label].default_value = checked

    def get(self, identifier: str) -> object:
        """Return an unlinked parameter's value: a number, or a list of three or four."""
        value = self.node.inputs[_BY_IDENTIFIER[identifier].label].default_value
        return list(value) if hasattr(value, "__len__") else value


def is_conductor(node: bpy.types.Node) -> bool:
    """Return whether this is a node of the conductor's group."""
    return (
        node.bl_idname == "ShaderNodeGroup"
        and node.node_tree is not None
        and node.node_tree.name.startswith(GROUP_NAME)
    )


def find_metals() -> list[Metal]:
    """Return the metals of the open file by rising object index.

    Raises RuntimeError where there is none, or where one of them holds no compiled shader.
    """
    metals = {}
    for thing in bpy.context.scene.objects:
        for slot in thing.material_slots:
            tree = slot.material.node_tree if slot.material else None
            if tree and any(is_conductor(node) for node in tree.nodes):
                metals[slot.material.name] = Metal(
                    slot.material.name, thing.pass_index, slot.material
                )
    if not metals:
        raise RuntimeError(f"{bpy.data.filepath} holds no metal: build it anew with 'make scenes'")
    for metal in metals.values():
        if not has_bytecode(metal.node.node_tree):
            raise RuntimeError(
                f"{metal.name} holds no compiled shader: build the file anew with 'make scenes'"
            )
    return sorted(metals.values(), key=lambda metal: metal.index)


def use_quality(metals: list[Metal], quality: str) -> None:
    """Show the metals with Microbounce at this quality ("Single", "Walk" ...)."""
    for metal in metals:
        metal.set("Quality", quality)
        _show(metal.material, metal.node)


def use_cycles_multiscatter(metals: list[Metal]) -> None:
    """Show the metals with Cycles' Metallic BSDF of the same values.

    GGX takes Multiscatter GGX. For Beckmann Cycles has one bounce and nothing else.
    """
    for metal in metals:
        tree = metal.material.node_tree
        native = tree.nodes.get(CYCLES_METAL)
        if native is None:
            native = tree.nodes.new("ShaderNodeBsdfMetallic")
            native.name = native.label = CYCLES_METAL
            native.location = (0, -500)
        native.distribution = "BECKMANN" if metal.get("Distribution") else "MULTI_GGX"
        native.fresnel_type = "PHYSICAL_CONDUCTOR" if metal.get("Fresnel") else "F82"
        for identifier in (*_COLOR[native.fresnel_type], *_SURFACE):
            label = _BY_IDENTIFIER[identifier].label
            source = metal.node.inputs[label]
            if source.is_linked:
                tree.links.new(source.links[0].from_socket, native.inputs[label])
            else:
                native.inputs[label].default_value = source.default_value
        _show(metal.material, native)


def _show(material: bpy.types.Material, node: bpy.types.Node) -> None:
    output = material.node_tree.get_output_node("CYCLES")
    material.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
