# SPDX-License-Identifier: GPL-3.0-or-later
"""The native metal that the node group shows where its script does not run."""

import bpy

from .sockets import input_socket

# Inputs of Cycles' Metallic BSDF, whose `fresnel_type` decides on the first two.
_NATIVE_COLOR = {"F82": ("Base Color", "Edge Tint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}
_NATIVE_SURFACE = ("Roughness", "Anisotropy", "Rotation")


def make_fallback(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node
) -> bpy.types.NodeSocketShader:
    """Add native metals, mixed by Distribution and Fresnel, and return their output.

    GGX takes Cycles' own energy compensation, the nearest to further bounces; Beckmann has none.
    """
    nodes, links = group.nodes, group.links
    geometry = nodes.new("ShaderNodeNewGeometry")
    geometry.location = (-900, -250)
    normal = _make_direction(group, inputs.outputs["Normal"], geometry.outputs["Normal"], -500)
    tangent = _make_direction(group, inputs.outputs["Tangent"], geometry.outputs["Tangent"], -800)

    def metal(distribution: str, fresnel: str, y: float) -> bpy.types.NodeSocketShader:
        node = nodes.new("ShaderNodeBsdfMetallic")
        node.distribution, node.fresnel_type = distribution, fresnel
        node.label = f"Fallback {distribution} {fresnel}"
        node.location = (-200, y)
        for label in (*_NATIVE_COLOR[fresnel], *_NATIVE_SURFACE):
            links.new(inputs.outputs[label], node.inputs[label])
        links.new(normal, node.inputs["Normal"])
        links.new(tangent, node.inputs["Tangent"])
        return node.outputs[0]

    def mix(
        factor: str,
        first: bpy.types.NodeSocketShader,
        second: bpy.types.NodeSocketShader,
        location: tuple[float, float],
    ) -> bpy.types.NodeSocketShader:
        node = nodes.new("ShaderNodeMixShader")
        node.location = location
        links.new(inputs.outputs[factor], node.inputs[0])
        links.new(first, node.inputs[1])
        links.new(second, node.inputs[2])
        return node.outputs[0]

    ggx = mix(
        "Fresnel",
        metal("MULTI_GGX", "F82", 0),
        metal("MULTI_GGX", "PHYSICAL_CONDUCTOR", -300),
        (150, -150),
    )
    beckmann = mix(
        "Fresnel",
        metal("BECKMANN", "F82", -600),
        metal("BECKMANN", "PHYSICAL_CONDUCTOR", -900),
        (150, -750),
    )
    return mix("Distribution", ggx, beckmann, (380, -400))


def _make_direction(
    group: bpy.types.ShaderNodeTree,
    given: bpy.types.NodeSocketVector,
    default: bpy.types.NodeSocketVector,
    y: float,
) -> bpy.types.NodeSocketVector:
    """Add nodes that pass on `given`, or `default` where it is no direction; return their output.

    A native metal is black where its tangent has length 0, as from a UV map that is missing, or
    where a component is not finite.
    """
    nodes, links = group.nodes, group.links
    # After this the length is 1; it stays 0 for zero, and infinities become NaN.
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
    links.new(usable.outputs[0], input_socket(mix, "Factor_Float"))
    links.new(default, input_socket(mix, "A_Vector"))
    links.new(finite.outputs["Vector"], input_socket(mix, "B_Vector"))
    return next(s for s in mix.outputs if s.identifier == "Result_Vector")
