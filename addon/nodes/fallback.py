# SPDX-License-Identifier: GPL-3.0-or-later
"""The native materials that the node groups show where their script does not run.

GGX takes Cycles' own energy compensation, the nearest to further bounces; Beckmann has none.
"""

import bpy

from ..core.kinds import Kind
from .sockets import input_socket

# Inputs of Cycles' Metallic BSDF, whose `fresnel_type` decides on the first two.
_METAL_COLOR = {"F82": ("Base Color", "Edge Tint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}
_METAL_SURFACE = ("Roughness", "Anisotropy", "Rotation")

# Oren and Nayar's roughness over ours. Spheres of albedo 0.8 under suns from three sides are then
# 4, 5, 9, 13 and 17 % (L2) off those of Walk at Roughness 0.3, 0.5, 0.7, 0.85 and 1; were ours
# passed on as it is, 12, 17, 22, 27 and 35 %.
MATTE_ROUGHNESS = 0.25

# Names that Cycles has for the group's distributions.
_DISTRIBUTIONS = ("MULTI_GGX", "BECKMANN")


def make_fallback(
    kind: Kind, group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node
) -> bpy.types.NodeSocketShader:
    """Add the native material nearest to `kind`, wired to the group's inputs; return its output."""
    geometry = group.nodes.new("ShaderNodeNewGeometry")
    geometry.location = (-900, -250)
    return _MAKERS[kind.identifier](group, inputs, geometry)


def _make_metal(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, geometry: bpy.types.Node
) -> bpy.types.NodeSocketShader:
    """Add Metallic BSDFs, mixed by Distribution and Fresnel."""
    normal = _make_direction(group, inputs.outputs["Normal"], geometry.outputs["Normal"], -500)
    tangent = _make_direction(group, inputs.outputs["Tangent"], geometry.outputs["Tangent"], -800)

    def metal(distribution: str, fresnel: str, y: float) -> bpy.types.NodeSocketShader:
        node = group.nodes.new("ShaderNodeBsdfMetallic")
        node.distribution, node.fresnel_type = distribution, fresnel
        _link_inputs(group, inputs, (*_METAL_COLOR[fresnel], *_METAL_SURFACE), node)
        group.links.new(normal, node.inputs["Normal"])
        node.label = f"Fallback {distribution} {fresnel}"
        node.location = (-200, y)
        group.links.new(tangent, node.inputs["Tangent"])
        return node.outputs[0]

    mixed = []
    for distribution, y in zip(_DISTRIBUTIONS, (0, -600), strict=True):
        metals = [metal(distribution, f, y - 300 * i) for i, f in enumerate(_METAL_COLOR)]
        mixed.append(_make_mix(group, inputs.outputs["Fresnel"], metals, (150, y - 150)))
    return _make_mix(group, inputs.outputs["Distribution"], mixed, (380, -400))


def _make_glass(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, geometry: bpy.types.Node
) -> bpy.types.NodeSocketShader:
    """Add Glass BSDFs, mixed by Distribution. Cycles' glass has no anisotropy."""
    normal = _make_direction(group, inputs.outputs["Normal"], geometry.outputs["Normal"], -500)
    glasses = []
    for distribution, y in zip(_DISTRIBUTIONS, (0, -300), strict=True):
        node = group.nodes.new("ShaderNodeBsdfGlass")
        node.distribution = distribution
        _link_inputs(group, inputs, ("Color", "IOR", "Roughness"), node)
        group.links.new(normal, node.inputs["Normal"])
        node.label = f"Fallback {distribution}"
        node.location = (-200, y)
        glasses.append(node.outputs[0])
    return _make_mix(group, inputs.outputs["Distribution"], glasses, (150, -150))


def _make_matte(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, geometry: bpy.types.Node
) -> bpy.types.NodeSocketShader:
    """Add a Diffuse BSDF, which has neither distributions nor anisotropy.

    Its Roughness is Oren and Nayar's, which flattens the shading much sooner than ours.
    """
    normal = _make_direction(group, inputs.outputs["Normal"], geometry.outputs["Normal"], -500)
    roughness = group.nodes.new("ShaderNodeMath")
    roughness.operation = "MULTIPLY"
    roughness.label = "Oren-Nayar Roughness"
    roughness.location = (-400, -150)
    roughness.inputs[1].default_value = MATTE_ROUGHNESS
    group.links.new(inputs.outputs["Roughness"], roughness.inputs[0])
    node = group.nodes.new("ShaderNodeBsdfDiffuse")
    node.label = "Fallback"
    node.location = (-200, 0)
    _link_inputs(group, inputs, ("Color",), node)
    group.links.new(roughness.outputs[0], node.inputs["Roughness"])
    group.links.new(normal, node.inputs["Normal"])
    return node.outputs[0]


_MAKERS = {"CONDUCTOR": _make_metal, "DIELECTRIC": _make_glass, "DIFFUSE": _make_matte}


def _link_inputs(
    group: bpy.types.ShaderNodeTree,
    inputs: bpy.types.Node,
    labels: tuple[str, ...],
    node: bpy.types.Node,
) -> None:
    """Link inputs of a native node to the group's of the same names."""
    for label in labels:
        group.links.new(inputs.outputs[label], node.inputs[label])


def _make_mix(
    group: bpy.types.ShaderNodeTree,
    factor: bpy.types.NodeSocket,
    closures: list[bpy.types.NodeSocketShader],
    location: tuple[float, float],
) -> bpy.types.NodeSocketShader:
    """Add a mix of two closures: the first at factor 0, the second at 1."""
    node = group.nodes.new("ShaderNodeMixShader")
    node.location = location
    for source, socket in zip((factor, *closures), node.inputs, strict=True):
        group.links.new(source, socket)
    return node.outputs[0]


def _make_direction(
    group: bpy.types.ShaderNodeTree,
    given: bpy.types.NodeSocketVector,
    default: bpy.types.NodeSocketVector,
    y: float,
) -> bpy.types.NodeSocketVector:
    """Add nodes that pass on `given`, or `default` where it is no direction; return their output.

    A native material is black where its normal or tangent has length 0, as from a UV map that is
    missing, or where a component is not finite.
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
