# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the conversion of each node of a material, and changes nothing."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ..core.kinds import KINDS
from ..material.animation import Curves, animated_inputs, input_curves
from ..material.graph import node_kind, surface_tree, trees_within
from ..material.node import why_not_editable
from .families import NATIVE_TYPES, translated_to_native, translated_to_ours
from .record import Record, merged, read_record
from .replace import lost_links, source_of
from .report import Entry
from .state import State, read_state
from .translation import NotConvertibleError, Translation

TO_OURS, TO_NATIVE = "TO_OURS", "TO_NATIVE"


@dataclass
class Step:
    """The conversion of one node.

    entry  -- the line for users
    state  -- the node's present values
    made   -- its translation
    record -- the record that was used, None if there was none
    curves -- the animation of its inputs
    """

    entry: Entry
    state: State
    made: Translation
    record: Record | None
    curves: Curves


def why_not_convertible(material: bpy.types.Material) -> str:
    """Return why nothing in `material` can be converted, with the remedy; "" if it can."""
    reason = why_not_editable(material)
    if not reason and surface_tree(material) is None:
        return f"The material '{material.name}' has no nodes: switch Use Nodes on"
    return reason


def find_steps(material: bpy.types.Material, direction: str) -> tuple[list[Step], list[Entry]]:
    """Return the nodes of `material` that convert, and those that stay, with the reasons.

    `direction` is TO_OURS or TO_NATIVE.
    """
    reason = why_not_convertible(material)
    if reason:
        return [], [Entry("", "", reason=reason)]
    tree = material.node_tree
    curves = input_curves(tree)
    steps, stay = [], []
    for node in tree.nodes:
        if not _is_candidate(node, direction):
            continue
        try:
            steps.append(_step(tree, node, direction, curves.get(node.name, {})))
        except NotConvertibleError as error:
            stay.append(Entry(node.name, _type_name(node), reason=str(error)))
    for group, node in _in_groups(tree, direction):
        stay.append(
            Entry(
                node.name,
                _type_name(node),
                reason=f"It is inside the node group '{group.name}', which other materials may "
                "use: ungroup it first (Ctrl Alt G)",
            )
        )
    return steps, stay


def _is_candidate(node: bpy.types.Node, direction: str) -> bool:
    return node.bl_idname in NATIVE_TYPES if direction == TO_OURS else bool(node_kind(node))


def _in_groups(
    tree: bpy.types.NodeTree, direction: str
) -> Iterator[tuple[bpy.types.NodeTree, bpy.types.Node]]:
    """Yield nodes inside the users' groups of `tree`, each once."""
    for group in trees_within(tree)[1:]:
        yield from ((group, node) for node in group.nodes if _is_candidate(node, direction))


def _step(tree: bpy.types.NodeTree, node: bpy.types.Node, direction: str, curves: Curves) -> Step:
    """Return the conversion of `node`. Raises NotConvertibleError if there is none."""
    animated = animated_inputs(node, curves)
    state, record = read_state(node, animated), read_record(node)
    kind = node_kind(node)
    notes = []
    if kind and not _is_complete(kind, node):
        raise NotConvertibleError(
            "Its node group is of another version, or was changed: take Update Materials first"
        )
    if direction == TO_OURS:
        made, record = _to_ours(state, record)
        target = KINDS[made.target].name
    else:
        made, record, notes = _to_native(kind, state, record)
        target = _class_name(made.target)
    stuck = sorted(animated - (made.carried.keys() - made.through.keys()))
    if stuck:
        raise NotConvertibleError(
            f"{', '.join(stuck)}: animated, which {target} cannot take. Remove the animation"
        )
    notes = [*notes, *made.notes]
    for link in lost_links(node, made.carried):
        notes.append(f"The link to {link.socket} has no counterpart: kept for the way back")
    for link in record.links if record is not None else ():
        if source_of(tree, link) is None:
            notes.append(f"{link.socket} was linked to '{link.node}', which is gone")
    return Step(
        Entry(node.name, _type_name(node), target, tuple(notes)), state, made, record, curves
    )


def _is_complete(kind: str, node: bpy.types.Node) -> bool:
    labels = {parameter.label for parameter in KINDS[kind].parameters}
    return labels <= {socket.name for socket in node.inputs} and "BSDF" in node.outputs


def _to_ours(state: State, record: Record | None) -> tuple[Translation, Record | None]:
    now = translated_to_ours(state)
    if record is None:
        return now, None
    try:
        then = translated_to_ours(record.made)
    except (NotConvertibleError, KeyError):  # the record is another version's
        return now, None
    if then.target != now.target:
        return now, None
    return merged(then, now, record.was), record


def _to_native(
    kind: str, state: State, record: Record | None
) -> tuple[Translation, Record | None, list[str]]:
    """Return the translation, the record if it was used, and why it was not."""
    notes = []
    if record is not None:
        try:
            now = translated_to_native(kind, state, record.was)
            then = translated_to_native(kind, record.made, record.was)
            return merged(then, now, record.was), record, notes
        except NotConvertibleError as error:
            was = _class_name(record.was.idname)
            notes = [f"It was a {was}, which cannot show it any more. {error}"]
        except KeyError:  # the record is another version's
            pass
    return translated_to_native(kind, state, None), None, notes


def _type_name(node: bpy.types.Node) -> str:
    kind = node_kind(node)
    return KINDS[kind].name if kind else _class_name(node.bl_idname)


def _class_name(idname: str) -> str:
    return getattr(bpy.types, idname).bl_rna.name
