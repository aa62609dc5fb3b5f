# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches the materials of an open scene between our qualities and Cycles' own closures."""

from dataclasses import dataclass

import bpy

from addon.core.kinds import Kind
from addon.material.graph import node_kind
from addon.material.group import has_bytecode
from addon.material.variants import Placed, placed_in


@dataclass(frozen=True)
class Material:
    """A material with one of our node groups, and the index of the objects that show it."""

    name: str
    index: int
    material: bpy.types.Material

    @property
    def placed(self) -> Placed:
        """The group node with its tree."""
        return next(placed_in([self.material.node_tree]))

    @property
    def node(self) -> bpy.types.ShaderNodeGroup:
        """The group node of the material."""
        return self.placed.node

    @property
    def kind(self) -> Kind:
        """The kind of the group: metal, glass or matte."""
        return self.placed.kind

    def set(self, identifier: str, value: object) -> None:
        """Set a parameter by its identifier. Raises as Parameter.checked()."""
        self.placed.set(identifier, value)

    def get(self, identifier: str) -> object:
        """Return an unlinked parameter's value: a number, or a list of three or four."""
        return self.placed.get(identifier)


def find_materials() -> list[Material]:
    """Return our materials of the open file, of all kinds, by rising object index.

    Raises RuntimeError if there is none, or if one has no compiled shader.
    """
    found = {}
    for thing in bpy.context.scene.objects:
        for slot in thing.material_slots:
            tree = slot.material.node_tree if slot.material else None
            if tree and any(node_kind(node) for node in tree.nodes):
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
        material.placed.show_ours()


def use_cycles_multiscatter(materials: list[Material]) -> None:
    """Show the materials with Cycles' own closure and the same values."""
    for material in materials:
        material.placed.show_cycles()
