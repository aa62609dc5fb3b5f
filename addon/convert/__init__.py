# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Cycles' own surface nodes to ours and back, without loss.

A converted node keeps the state of the node it was made from. The way back restores that state and
translates later changes. Nodes keep their names, places and looks both ways, and links and
animation of inputs that both have. A link whose values need a formula goes through nodes for it.
"""

from collections.abc import Iterable

import bpy

from ..material.animation import animated_inputs
from ..material.group import material_group
from .record import Record, write_record
from .replace import lost_links, take_place
from .report import Conversion, Entry
from .state import State, read_state, write_state
from .steps import TO_NATIVE, TO_OURS, Step, find_steps

__all__ = [
    "TO_NATIVE",
    "TO_OURS",
    "Conversion",
    "Entry",
    "needed_groups",
    "plan",
    "to_microbounce",
    "to_native",
]


def plan(material: bpy.types.Material, direction: str = TO_OURS) -> Conversion:
    """Return what `to_microbounce` or `to_native` would do, and change nothing.

    `direction` is TO_OURS or TO_NATIVE. Raises ValueError for another, and TypeError if `material`
    is not a material.
    """
    steps, stay = _checked_steps(material, direction)
    return _conversion(material, steps, stay)


def needed_groups(materials: Iterable[bpy.types.Material]) -> dict[str, bpy.types.NodeTree]:
    """Return the node groups, by kind, that `to_microbounce` puts into `materials`.

    Makes them if the file has none. Raises one of GROUP_ERRORS if that fails.
    """
    steps = [step for material in materials for step in _checked_steps(material, TO_OURS)[0]]
    return {kind: material_group(kind) for kind in sorted({step.made.target for step in steps})}


def to_microbounce(
    material: bpy.types.Material, groups: dict[str, bpy.types.NodeTree] | None = None
) -> Conversion:
    """Replace native nodes that have a counterpart by ours.

    `groups` are the `needed_groups`, which are found here if None. Pass them for many materials,
    because finding them takes most of the time. Raises one of GROUP_ERRORS if a node group cannot
    be made; nothing is changed then.
    """
    steps, stay = _checked_steps(material, TO_OURS)
    if groups is None:
        groups = needed_groups([material])
    for step in steps:
        node = material.node_tree.nodes.new("ShaderNodeGroup")
        node.node_tree = groups[step.made.target]
        node.width = node.node_tree.default_group_node_width
        _apply(material.node_tree, step, node)
    return _conversion(material, steps, stay)


def to_native(material: bpy.types.Material) -> Conversion:
    """Replace our nodes by the native nodes they were made from, or by the closest ones."""
    steps, stay = _checked_steps(material, TO_NATIVE)
    for step in steps:
        _apply(material.node_tree, step, material.node_tree.nodes.new(step.made.target))
    return _conversion(material, steps, stay)


def _checked_steps(material: bpy.types.Material, direction: str) -> tuple[list[Step], list[Entry]]:
    if not isinstance(material, bpy.types.Material):
        raise TypeError(f"The material is {material!r}: give a bpy.types.Material")
    if direction not in (TO_OURS, TO_NATIVE):
        raise ValueError(f"The direction is {direction!r}: use TO_OURS or TO_NATIVE")
    return find_steps(material, direction)


def _conversion(material: bpy.types.Material, steps: list[Step], stay: list[Entry]) -> Conversion:
    return Conversion(material.name, (*(step.entry for step in steps), *stay))


def _apply(tree: bpy.types.NodeTree, step: Step, new: bpy.types.Node) -> None:
    """Put `new` in the place of the step's node."""
    old, used, made = tree.nodes[step.entry.node], step.record, step.made
    hidden, panels = (used.was.hidden, used.was.panels) if used is not None else ([], {})
    write_state(new, State(new.bl_idname, made.settings, made.values, [], hidden, panels))
    animated = animated_inputs(old, step.curves)
    lost = lost_links(old, made.carried)
    take_place(tree, old, new, made, used.links if used is not None else [], step.curves)
    # A converted node that nobody changed is made again by converting from scratch.
    untouched = used is not None and used.fresh and used.made.holds_the_same(step.state)
    if not untouched or lost:
        now = read_state(new, frozenset(made.carried[name] for name in animated))
        write_record(new, Record(was=step.state, links=lost, made=now, fresh=used is None))
