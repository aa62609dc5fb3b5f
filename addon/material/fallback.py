# SPDX-License-Identifier: GPL-3.0-or-later
"""The native materials that the node groups show if their script does not run.

GGX takes Cycles' own energy compensation, which is closest to further bounces. Beckmann has none.
"""

import bpy

from ..core.kinds import Kind
from .directions import Directions

# Inputs of Cycles' Metallic BSDF, whose `fresnel_type` decides on the first two.
_METAL_COLOR = {"F82": ("Base Color", "Edge Tint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}
_METAL_SURFACE = ("Roughness", "Anisotropy", "Rotation")

# Oren and Nayar's roughness over ours. Spheres of albedo 0.8 under suns from three sides are then
# 4, 5, 9, 13 and 17 % (L2) off those of Walk at Roughness 0.3, 0.5, 0.7, 0.85 and 1. Without the
# factor they are 12, 17, 22, 27 and 35 % off.
MATTE_ROUGHNESS = 0.25

# Cycles' names for the group's distributions.
_DISTRIBUTIONS = ("MULTI_GGX", "BECKMANN")


def make_fallback(
    kind: Kind,
    group: bpy.types.ShaderNodeTree,
    inputs: bpy.types.Node,
    directions: Directions,
) -> bpy.types.NodeSocketShader:
    """Add the native material closest to `kind`, wired to the group's inputs; return its output."""
    return _MAKERS[kind.identifier](group, inputs, directions)


def _make_metal(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, directions: Directions
) -> bpy.types.NodeSocketShader:
    """Add Metallic BSDFs, mixed by Distribution and Fresnel."""

    def metal(distribution: str, fresnel: str, y: float) -> bpy.types.NodeSocketShader:
        node = group.nodes.new("ShaderNodeBsdfMetallic")
        node.distribution, node.fresnel_type = distribution, fresnel
        _link_inputs(group, inputs, (*_METAL_COLOR[fresnel], *_METAL_SURFACE), node)
        group.links.new(directions.normal, node.inputs["Normal"])
        node.label = f"Fallback {distribution} {fresnel}"
        node.location = (-200, y)
        group.links.new(directions.tangent, node.inputs["Tangent"])
        return node.outputs[0]

    mixed = []
    for distribution, y in zip(_DISTRIBUTIONS, (0, -600), strict=True):
        metals = [metal(distribution, f, y - 300 * i) for i, f in enumerate(_METAL_COLOR)]
        mixed.append(_make_mix(group, inputs.outputs["Fresnel"], metals, (150, y - 150)))
    return _make_mix(group, inputs.outputs["Distribution"], mixed, (380, -400))


def _make_glass(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, directions: Directions
) -> bpy.types.NodeSocketShader:
    """Add Glass BSDFs, mixed by Distribution. Cycles' glass has no anisotropy."""
    glasses = []
    for distribution, y in zip(_DISTRIBUTIONS, (0, -300), strict=True):
        node = group.nodes.new("ShaderNodeBsdfGlass")
        node.distribution = distribution
        _link_inputs(group, inputs, ("Color", "IOR", "Roughness"), node)
        group.links.new(directions.normal, node.inputs["Normal"])
        node.label = f"Fallback {distribution}"
        node.location = (-200, y)
        glasses.append(node.outputs[0])
    return _make_mix(group, inputs.outputs["Distribution"], glasses, (150, -150))


def _make_matte(
    group: bpy.types.ShaderNodeTree, inputs: bpy.types.Node, directions: Directions
) -> bpy.types.NodeSocketShader:
    """Add a Diffuse BSDF, which has neither distributions nor anisotropy.

    Its Roughness is Oren and Nayar's, which flattens the shading much sooner than ours.
    """
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
    group.links.new(directions.normal, node.inputs["Normal"])
    return node.outputs[0]


_MAKERS = {"CONDUCTOR": _make_metal, "DIELECTRIC": _make_glass, "DIFFUSE": _make_matte}


def _link_inputs(
    group: bpy.types.ShaderNodeTree,
    inputs: bpy.types.Node,
    labels: tuple[str, ...],
    node: bpy.types.Node,
) -> None:
    """Link inputs of a native node to the group's inputs of the same names."""
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
