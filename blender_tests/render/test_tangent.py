# SPDX-License-Identifier: GPL-3.0-or-later
"""Where no tangent is linked the anisotropy lies as on Cycles' own materials."""

import bpy
import numpy as np
import pytest

from addon.core.kinds import KINDS
from addon.material.node import new_material
from scenes import common, pictures

SIZE = 32
EVERYWHERE = np.ones((SIZE, SIZE), dtype=bool)


def _sphere(material: bpy.types.Material) -> bpy.types.Object:
    return common.add_unit_sphere(material)


def _curve(material: bpy.types.Material) -> bpy.types.Object:
    """A tube, whose generated coordinates and derivatives are those of a mesh."""
    curve = bpy.data.curves.new("Tube", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = 0.4
    spline = curve.splines.new("POLY")
    spline.points.add(2)
    for point, place in zip(
        spline.points, ((-0.8, 0, -0.5), (0, 0, 0.5), (0.8, 0, -0.5)), strict=True
    ):
        point.co = (*place, 1.0)
    curve.materials.append(material)
    return common.add_object("Tube", curve)


def _hair(material: bpy.types.Material) -> bpy.types.Object:
    """Thick strands, which Cycles renders as curves."""
    strands = bpy.data.hair_curves.new("Strands")
    strands.add_curves([2, 2, 2])
    ends = [(x, 0.0, z) for x in (-0.6, 0.0, 0.6) for z in (-0.8, 0.8)]
    strands.attributes["position"].data.foreach_set("vector", np.float32(ends).ravel())
    radius = strands.attributes.new("radius", "FLOAT", "POINT")
    radius.data.foreach_set("value", np.full(6, 0.25, dtype=np.float32))
    strands.materials.append(material)
    return common.add_object("Strands", strands)


def _start(scale: float = 1.0) -> None:
    """A camera and a sun in an empty scene; lengths are `scale`."""
    scene = common.start_scene((SIZE, SIZE), samples=64)
    common.set_world(scene, (0.1, 0.1, 0.1))
    scene.cycles.max_bounces = 0
    camera = common.add_front_camera(scene)
    camera.data.ortho_scale *= scale
    camera.location *= scale
    camera.data.clip_start, camera.data.clip_end = 0.01 * scale, 20.0 * scale
    light = bpy.data.lights.new("Sun", "SUN")
    light.angle = 0.5
    common.aim(common.add_object("Sun", light), (-0.6, 0.7, -0.5))


@pytest.mark.parametrize("make", [_sphere, _curve, _hair], ids=["sphere", "tube", "hair"])
@pytest.mark.parametrize(("scale", "rotation"), [(1.0, 0.0), (1e-5, 0.0), (1.0, 0.15)])
def test_default_tangent_is_cycles(make, scale: float, rotation: float) -> None:
    """The shader's Single against Cycles' Metallic BSDF, turned or not.

    Both are the same GGX closure; 1 % is the noise of their different random numbers.
    """
    _start(scale)
    values = {"Roughness": 0.6, "Anisotropy": 0.9, "Rotation": rotation, "Quality": "Single"}
    metal = new_material("CONDUCTOR", "Metal", **values)
    native = new_material("CONDUCTOR", "Native", **values)
    group = native.node_tree.nodes["Microbounce Conductor"]
    metallic = native.node_tree.nodes.new("ShaderNodeBsdfMetallic")
    metallic.distribution = "GGX"
    for name in ("Base Color", "Edge Tint", "Roughness", "Anisotropy", "Rotation"):
        metallic.inputs[name].default_value = group.inputs[name].default_value
    output = native.node_tree.get_output_node("CYCLES")
    native.node_tree.links.new(metallic.outputs[0], output.inputs["Surface"])
    added = make(metal)
    added.scale = (scale, scale, scale)

    ours = pictures.picture(64)
    added.data.materials[0] = native
    for modifier in added.modifiers:
        modifier.node_group.nodes["Set Material"].inputs["Material"].default_value = native
    theirs = pictures.picture(64)
    assert theirs.max() > 0.1
    assert pictures.l2_error(ours, theirs, EVERYWHERE) < 0.01


@pytest.mark.parametrize("kind", KINDS)
def test_default_tangent_is_about_the_z_axis(kind: str) -> None:
    """Alone in its file each material finds what Cycles' Tangent node gives, linked to it.

    The random numbers are the same, and a quarter of a turn must make a difference.
    """
    _start()
    material = new_material(kind, "Alone", Roughness=0.6, Anisotropy=0.9, Quality="Walk")
    common.add_unit_sphere(material)
    tree = material.node_tree
    inputs = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup").inputs
    inputs["Rotation"].default_value = 0.25
    turned = pictures.picture(64)
    inputs["Rotation"].default_value = 0.0
    default = pictures.picture(64)
    tangent = tree.nodes.new("ShaderNodeTangent")
    tangent.direction_type, tangent.axis = "RADIAL", "Z"
    tree.links.new(tangent.outputs[0], inputs["Tangent"])
    linked = pictures.picture(64)
    assert pictures.l2_error(default, linked, EVERYWHERE) < 0.01
    assert pictures.l2_error(default, turned, EVERYWHERE) > 0.05
