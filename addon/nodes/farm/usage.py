# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the materials of a file that use our node groups, and all node trees that they reach."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ..find import surface_tree
from ..group import KIND_KEY


@dataclass(frozen=True)
class Use:
    """A material, the node trees that it reaches, its own first, and those of them that are ours.

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
    trees, groups = [], []
    tree = surface_tree(material)
    waiting = [] if tree is None else [tree]
    seen = set(waiting)
    while waiting:
        tree = waiting.pop(0)
        trees.append(tree)
        for node in tree.nodes:
            group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
            if group is None or group in seen:
                continue
            seen.add(group)
            if KIND_KEY in group:
                groups.append(group)
            else:
                waiting.append(group)
    return Use(material, tuple(trees), tuple(groups))
