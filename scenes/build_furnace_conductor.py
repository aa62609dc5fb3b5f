# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds furnace_conductor.blend: a unit sphere of white metal in a uniform world of radiance 1.

A lossless surface that keeps all light reflects exactly the radiance 1 everywhere, so that the
sphere cannot be seen; what a model loses shows as darkening.
"""

from addon.nodes.conductor import conductor_material

from . import common

RESOLUTION = 64


def build() -> None:
    """Build the scene and save it."""
    scene = common.start_scene((RESOLUTION, RESOLUTION), samples=64)
    common.use_box_filter(scene)
    white = (1.0, 1.0, 1.0)
    common.set_world(scene, white)
    # A path that grazes a facet and meets the sphere again goes on, instead of losing its light.
    scene.cycles.max_bounces = 8
    scene.cycles.glossy_bounces = 8
    scene.cycles.diffuse_bounces = 8
    common.add_front_camera(scene)
    common.add_unit_sphere(conductor_material("White Metal", BaseColor=white, EdgeTint=white))
    common.save("furnace_conductor")


if __name__ == "__main__":
    build()
