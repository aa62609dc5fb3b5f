# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds materials that have surfaces, and the nodes of ours in a node tree and its groups."""

from collections.abc import Iterator

import bpy

from ..core.kinds import KINDS
from .group import KIND_KEY

_NAMES = frozenset(kind.name for kind in KINDS.values())


def surface_tree(material: bpy.types.Material) -> bpy.types.ShaderNodeTree | None:
    """Return the node tree that `material` renders by, None where it has none."""
    # Later nodes are always on, and the property is deprecated.
    on = bpy.app.version >= (5, 0, 0) or material.use_nodes
    return material.node_tree if on else None


def surface_materials() -> list[bpy.types.Material]:
    """Return the file's materials but those of grease pencil, which have no surface."""
    return [material for material in bpy.data.materials if not material.is_grease_pencil]


def our_nodes(tree: bpy.types.NodeTree) -> Iterator[bpy.types.ShaderNodeGroup]:
    """Yield the nodes in `tree`, or in a group within it, whose group is one of ours.

    Muted nodes and what is in muted groups are left out. Each group is looked into once.
    """
    trees, seen = [tree], {tree}
    while trees:
        for node in trees.pop().nodes:
            group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
            if group is None or node.mute:
                continue
            if is_ours(group):
                yield node
            elif group not in seen:
                seen.add(group)
                trees.append(group)


def is_ours(group: bpy.types.NodeTree) -> bool:
    """Return whether `group` is one of ours, also one whose library is gone.

    Of that Blender keeps an empty stand-in with nothing but its name.
    """
    if group.is_missing:
        return group.name.split(".")[0] in _NAMES
    return KIND_KEY in group
