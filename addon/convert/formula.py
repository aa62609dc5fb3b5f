# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas between inputs of native nodes and ours, for a value or as nodes in a link.

The way back removes the nodes that a conversion inserted, unless they were changed.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import bpy

from ..material.animation import input_curves
from ..material.sockets import SocketValue

# Marks the nodes that a conversion inserted.
INSERTED_KEY = "microbounce_inserted"

_GAMMA, _MATH = "ShaderNodeGamma", "ShaderNodeMath"
_SPACING = 160.0  # between the left edges of inserted nodes

# As Cycles computes them.
_OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "ADD": lambda x, constant: x + constant,
    "MULTIPLY": lambda x, constant: x * constant,
    "POWER": lambda x, constant: x**constant if x > 0.0 else 0.0,
    "FRACT": lambda x, _: x - math.floor(x) if math.isfinite(x) else x,
    "GAMMA": lambda x, constant: x**constant if x > 0.0 else x,
}


@dataclass(frozen=True)
class Operation:
    """One node: its operation, its second operand, and whether its result is cut to 0 to 1.

    GAMMA works on colours; the others are operations of a Math node.
    """

    name: str
    constant: float = 0.0
    clamp: bool = False

    def of(self, x: float) -> float:
        """Return the result for a number."""
        result = _OPERATIONS[self.name](x, self.constant)
        return max(0.0, min(1.0, result)) if self.clamp else result

    def make(self, node: bpy.types.Node) -> None:
        """Set the node, which is of type `idname`."""
        node.inputs[1].default_value = self.constant
        if self.idname == _MATH:
            node.operation, node.use_clamp = self.name, self.clamp

    def is_made_by(self, node: bpy.types.Node) -> bool:
        """Return whether `node` was inserted for this, and still does it."""
        return (
            INSERTED_KEY in node
            and node.bl_idname == self.idname
            and not node.mute
            and not node.inputs[1].is_linked
            and math.isclose(node.inputs[1].default_value, self.constant, rel_tol=1e-6)
            and (
                self.idname != _MATH
                or (node.operation == self.name and node.use_clamp == self.clamp)
            )
        )

    @property
    def idname(self) -> str:
        """The type of the node."""
        return _GAMMA if self.name == "GAMMA" else _MATH


@dataclass(frozen=True)
class Formula:
    """Operations, one after the other."""

    operations: tuple[Operation, ...]

    def __call__(self, value: SocketValue) -> SocketValue:
        """Return the result for a number, or for the components of a colour but its alpha."""
        if isinstance(value, list):
            return [*map(self, value[:3]), *value[3:]]
        for operation in self.operations:
            value = operation.of(value)
        return value

    def insert(self, source: bpy.types.NodeSocket, beside: bpy.types.Node) -> bpy.types.NodeSocket:
        """Put nodes for it behind `source` and to the left of `beside`; return their output."""
        tree, count = beside.id_data, len(self.operations)
        for number, operation in enumerate(self.operations):
            node = tree.nodes.new(operation.idname)
            operation.make(node)
            node[INSERTED_KEY] = True
            node.hide, node.select, node.parent = True, False, beside.parent
            x, y = beside.location
            node.location = (x - _SPACING * (count - number), y)
            tree.links.new(source, node.inputs[0])
            source = node.outputs[0]
        return source

    def inserted(
        self, source: bpy.types.NodeSocket
    ) -> tuple[bpy.types.NodeSocket, list[bpy.types.Node]] | None:
        """Return the input of the nodes that were inserted for it before `source`, and those nodes.

        The nodes go from the last to the first. None if there are none, or they were changed.
        """
        curves, nodes = input_curves(source.id_data), []
        for operation in reversed(self.operations):
            node = source.node
            if not operation.is_made_by(node) or node.name in curves:
                return None
            links = node.inputs[0].links
            if len(links) != 1 or links[0].is_muted:
                return None
            nodes.append(node)
            source = links[0].from_socket
        return source, nodes
