# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the materials of a file that use our node groups, and all node trees that they reach."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ..material.graph import group_nodes, is_our_group, surface_tree, trees_within


@dataclass(frozen=True)
class Use:
    """A material, the node trees that it reaches (its own first), and our groups among them.

    `trees` go into node groups, but not into ours.
    """

    material: bpy.types.Material
    trees: tuple[bpy.types.NodeTree, ...]
    groups: tuple[bpy.types.NodeTree, ...]

    @property
    def used(self) -> bool:
        """Whether anything but a fake user holds the material."""
        return is_used(self.material)


def is_used(data: bpy.types.ID) -> bool:
    """Return whether anything but a fake user holds a data-block."""
    return data.users > int(data.use_fake_user)


def material_uses() -> Iterator[Use]:
    """Yield every material of the file that has a group of ours."""
    for material in bpy.data.materials:
        use = material_use(material)
        if use.groups:
            yield use


def material_use(material: bpy.types.Material) -> Use:
    """Return the node trees that `material` reaches."""
    tree = surface_tree(material)
    trees = trees_within(tree) if tree is not None else []
    groups = (node.node_tree for each in trees for node in group_nodes(each))
    return Use(material, tuple(trees), tuple(dict.fromkeys(filter(is_our_group, groups))))
