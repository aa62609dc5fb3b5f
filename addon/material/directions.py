# SPDX-License-Identifier: GPL-3.0-or-later
"""The Normal and Tangent of a node group: the linked ones, or the surface's own."""

from typing import NamedTuple

import bpy

from .graph import socket_named


class Directions(NamedTuple):
    """Outputs that are unit vectors everywhere."""

    normal: bpy.types.NodeSocketVector
    tangent: bpy.types.NodeSocketVector


def make_directions(group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node) -> Directions:
    """Add nodes that pass on the group's Normal and Tangent, or the surface's own."""
    geometry = group.nodes.new("ShaderNodeNewGeometry")
    geometry.location = (-900, -250)
    names = (("Normal", -500), ("Tangent", -800))
    return Directions(
        *(_make_direction(group, inputs.outputs[n], geometry.outputs[n], y) for n, y in names)
    )


def _make_direction(
    group: bpy.types.ShaderNodeTree,
    given: bpy.types.NodeSocketVector,
    default: bpy.types.NodeSocketVector,
    y: float,
) -> bpy.types.NodeSocketVector:
    """Add nodes that pass on `given`, or `default` if it has no direction; return their output.

    A native material is black if its normal or tangent has length 0, as from a UV map that is
    missing, or where a component is not finite.
    """
    nodes, links = group.nodes, group.links
    # After this the length is 1, or 0 for a zero vector. Infinities become NaN.
    unit = nodes.new("ShaderNodeVectorMath")
    unit.operation = "NORMALIZE"
    unit.location = (-900, y)
    links.new(given, unit.inputs[0])
    length = nodes.new("ShaderNodeVectorMath")
    length.operation = "LENGTH"
    length.location = (-750, y)
    links.new(unit.outputs["Vector"], length.inputs[0])
    # No comparison with NaN is true.
    usable = nodes.new("ShaderNodeMath")
    usable.operation = "GREATER_THAN"
    usable.location = (-600, y)
    usable.inputs[1].default_value = 0.5
    links.new(length.outputs["Value"], usable.inputs[0])
    # Division by 0 gives 0 here, so that no NaN reaches the mix, where 0 times NaN is NaN.
    finite = nodes.new("ShaderNodeVectorMath")
    finite.operation = "DIVIDE"
    finite.location = (-600, y - 150)
    links.new(given, finite.inputs[0])
    links.new(usable.outputs[0], finite.inputs[1])
    mix = nodes.new("ShaderNodeMix")
    mix.data_type = "VECTOR"
    mix.label = f"{given.name} or Default"
    mix.location = (-400, y)
    links.new(usable.outputs[0], socket_named(mix.inputs, "Factor_Float"))
    links.new(default, socket_named(mix.inputs, "A_Vector"))
    links.new(finite.outputs["Vector"], socket_named(mix.inputs, "B_Vector"))
    return next(s for s in mix.outputs if s.identifier == "Result_Vector")
