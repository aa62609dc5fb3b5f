# SPDX-License-Identifier: GPL-3.0-or-later
"""F-curves and drivers of node inputs. Blender finds an input by its number."""

import re
from collections.abc import Iterator

import bpy

_INPUT = re.compile(r'nodes\["(?P<node>(?:[^"\\]|\\.)*)"\]\.inputs\[(?P<number>\d+)\](?P<rest>.*)')

# The numbers of a node's inputs that have curves, and those curves.
Curves = dict[int, list[bpy.types.FCurve]]


def input_curves(tree: bpy.types.NodeTree) -> dict[str, Curves]:
    """Return the curves and drivers of node inputs in `tree`, by the names of the nodes."""
    found: dict[str, Curves] = {}
    for curve in animation_curves(tree.animation_data):
        match = _INPUT.fullmatch(curve.data_path)
        if match:
            name = bpy.utils.unescape_identifier(match["node"])
            found.setdefault(name, {}).setdefault(int(match["number"]), []).append(curve)
    return found


def animated_inputs(node: bpy.types.Node, curves: Curves) -> frozenset[str]:
    """Return the names of the node's inputs that have curves or drivers."""
    return frozenset(node.inputs[number].name for number in curves if number < len(node.inputs))


def move_curves(
    curves: Curves, before: list[str], node: bpy.types.Node, names: dict[str, str]
) -> None:
    """Move curves of the inputs named `before`, in that order, to inputs of `node`.

    `names` are the new names by the old ones. Curves of other inputs stay.
    """
    numbers = {socket.name: number for number, socket in enumerate(node.inputs)}
    prefix = f'nodes["{bpy.utils.escape_identifier(node.name)}"]'
    for number, found in curves.items():
        name = names.get(before[number]) if number < len(before) else None
        if name not in numbers:
            continue
        for curve in found:
            rest = _INPUT.fullmatch(curve.data_path)["rest"]
            curve.data_path = f"{prefix}.inputs[{numbers[name]}]{rest}"


def animation_curves(data: bpy.types.AnimData | None) -> Iterator[bpy.types.FCurve]:
    """Yield the drivers and the curves of the action and of all NLA strips, each once."""
    if data is None:
        return
    yield from data.drivers
    used = [(data.action, data.action_slot)]
    strips = [strip for track in data.nla_tracks for strip in track.strips]
    for strip in strips:
        strips += strip.strips  # of a meta strip
        used.append((strip.action, strip.action_slot))
    seen = set()
    for action, slot in used:
        if action is None or slot is None or (action, slot.handle) in seen:
            continue
        seen.add((action, slot.handle))
        for layer in action.layers:
            for strip in layer.strips:
                bag = strip.channelbag(slot)
                if bag is not None:
                    yield from bag.fcurves
