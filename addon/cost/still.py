# SPDX-License-Identifier: GPL-3.0-or-later
"""Stops animation that would override the values of a variant."""

from collections.abc import Collection, Iterable, Iterator

import bpy

from ..material.animation import animation_curves
from ..material.variants import Placed

_VALUE = ".default_value"


def hold_still(nodes: Iterable[Placed], identifiers: Collection[str]) -> list[str]:
    """Mute keyframes and drivers of these parameters of the nodes; return the labels they had.

    Each keeps its present value until it is set. Other inputs stay animated.
    """
    held: dict[str, None] = {}
    for placed in nodes:
        labels = {
            placed.node.inputs[label]: label
            for label in (placed.kind.by_identifier[name].label for name in identifiers)
        }
        for curve, socket in _moved_sockets(placed.tree):
            if socket in labels:
                curve.mute = True
                held[labels[socket]] = None
    return list(held)


def _moved_sockets(
    tree: bpy.types.NodeTree,
) -> Iterator[tuple[bpy.types.FCurve, bpy.types.NodeSocket]]:
    """Yield the curves and drivers of sockets, however their paths name them."""
    for curve in animation_curves(tree.animation_data):
        path = curve.data_path
        if curve.mute or not path.endswith(_VALUE):
            continue
        try:
            yield curve, tree.path_resolve(path.removesuffix(_VALUE))
        except ValueError:  # of a node that is gone: it moves nothing
            continue
