# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the scene of the preset pictures: a grooved ball on a checkered stage in soft light."""

import math

import bpy

from scenes import common, shapes

SIZE = 104  # pixels along each side of a picture
SAMPLES = 40

# The stage's two colours. Glass shows their borders bent.
_LIGHT, _DARK = (0.46, 0.46, 0.46), (0.22, 0.22, 0.23)
_SQUARE = 0.62  # length of a square's side
_RADIUS = 1.0
_GROOVE = (0.22, 0.075, 0.12)  # height of its middle, half its width, depth
_TILT = (math.radians(26.0), math.radians(-14.0), 0.0)  # towards the camera and aside


def build() -> tuple[bpy.types.Scene, bpy.types.Object]:
    """Empty the file; return the scene and its ball, which has no material yet."""
    scene = common.start_scene((SIZE, SIZE), SAMPLES)
    cycles = scene.cycles
    cycles.max_bounces = 8
    cycles.diffuse_bounces = 2
    cycles.glossy_bounces = 4
    cycles.transmission_bounces = 8
    # These cost light, but a picture this small would show it as noise.
    cycles.sample_clamp_indirect = 4.0
    cycles.use_denoising = True
    cycles.denoiser = "OPENIMAGEDENOISE"
    scene.render.use_persistent_data = True
    scene.view_settings.view_transform = "Khronos PBR Neutral"
    common.set_world(scene, (0.38, 0.40, 0.43))
    _add_stage()
    # A large window, a strip for the edge, and a ceiling.
    for name, location, size, watts in (
        ("Window", (-3.4, -3.4, 3.6), (2.6, 2.6), 270.0),
        ("Strip", (3.3, 0.6, 2.2), (0.7, 3.2), 130.0),
        ("Ceiling", (0.2, 0.6, 5.0), (3.0, 2.0), 110.0),
    ):
        common.add_area_light(name, location, (0.0, 0.0, 0.9), size, watts)
    camera = common.add_camera(scene, (0.0, -7.2, 2.35), (0.0, 7.2, -1.38), 19.6)
    camera.data.sensor_fit = "HORIZONTAL"
    return scene, _add_ball()


def profile() -> list[shapes.Point]:
    """Return the outline (radius, height) of the ball from pole to pole, with its groove."""
    middle, half, depth = _GROOVE
    steps = 240
    points = [(0.0, -_RADIUS)]
    for index in range(1, steps):
        angle = math.pi * (index / steps - 0.5)
        height = _RADIUS * math.sin(angle)
        inside = max(0.0, 1.0 - ((height - middle) / half) ** 2)
        points.append((_RADIUS * math.cos(angle) - depth * inside, height))
    return [*points, (0.0, _RADIUS)]


def _add_ball() -> bpy.types.Object:
    mesh = shapes.lathe("Ball", profile(), segments=160)
    mesh.materials.append(None)
    ball = common.add_object("Ball", mesh)
    ball.location = (0.0, 0.0, _RADIUS)
    ball.rotation_euler = _TILT
    return ball


def _add_stage() -> None:
    mesh = shapes.cyclorama("Stage", width=24.0, front=-12.0, back=4.2, height=9.0, bend=1.6)
    mesh.materials.append(_checkered())
    common.add_object("Stage", mesh)


def _checkered() -> bpy.types.Material:
    material = bpy.data.materials.new("Stage")
    if bpy.app.version < (5, 0, 0):  # later it is always on, and setting it is deprecated
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    where = tree.nodes.new("ShaderNodeTexCoord")
    # Moves the squares off the floor, where those of the third direction would flicker.
    shift = tree.nodes.new("ShaderNodeVectorMath")
    shift.inputs[1].default_value = (0.5 * _SQUARE, 0.1, 0.5 * _SQUARE)
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Color1"].default_value = (*_LIGHT, 1.0)
    checker.inputs["Color2"].default_value = (*_DARK, 1.0)
    checker.inputs["Scale"].default_value = 1.0 / _SQUARE
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    for source, target in (
        (where.outputs["Object"], shift.inputs[0]),
        (shift.outputs[0], checker.inputs["Vector"]),
        (checker.outputs["Color"], diffuse.inputs["Color"]),
        (diffuse.outputs[0], output.inputs["Surface"]),
    ):
        tree.links.new(source, target)
    return material
