# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds sphere_sun_conductor.blend: a unit sphere of white metal under a sun, in a black world.

Each pixel is a mean of BRDF values times a cosine, which the oracle computes as well: see
blender_tests/oracle/sphere.py for the same geometry.
"""

import bpy

from addon.nodes.conductor import conductor_material

from . import common

RESOLUTION = 64
# Towards the sun, before it is normalised; its irradiance on a surface that faces it is 1.
SUN_DIRECTION = (0.6, -0.72, 0.35)


def build() -> None:
    """Build the scene and save it."""
    scene = common.start_scene((RESOLUTION, RESOLUTION), samples=256)
    common.use_box_filter(scene)
    common.set_world(scene, (0.0, 0.0, 0.0))
    # The sphere is convex: what it reflects never meets it again.
    scene.cycles.max_bounces = 0
    common.add_front_camera(scene)
    white = (1.0, 1.0, 1.0)
    common.add_unit_sphere(conductor_material("White Metal", BaseColor=white, EdgeTint=white))
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = 1.0
    light.angle = 0.0
    sun = common.add_object("Sun", light)
    common.aim(sun, tuple(-component for component in SUN_DIRECTION))
    common.save("sphere_sun_conductor")


if __name__ == "__main__":
    build()
