# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the fixtures: scenes in which each pixel is a number that the oracle computes too.

Only camera rays see their objects, so light meets the surface once. Reflected or refracted light
always goes on to the sun or the world. A pixel shows one facet of the macrosurface. The materials
lose no light; tests set other values.

    sphere_sun_*   a unit sphere under a sun of irradiance 1 in a black world: BSDF times cosine.
                   The camera is common.add_front_camera(). `aim_sun(BACK_SUN)` lights it from
                   behind, through all facets that face the camera.
    furnace_*      the same sphere in a uniform world of radiance 1: directional albedo.
                   `turn_inside_out()` shows the surface from inside the solid.
    slab_*         one rough side of a slab: the plane z = 0 with its normal up. A sun shines up
                   through it. A perspective camera looks down on it, along the picture's middle
                   column at angles of 31 to 81 degrees from the normal.
"""

import bpy

from addon.core.kinds import kind_named
from addon.material.node import new_material

from . import common

RESOLUTION = 64

# Directions to the sun, not normalised.
FRONT_SUN = (0.6, -0.72, 0.35)
BACK_SUN = (0.45, 0.85, 0.25)
SLAB_SUN = (0.1, 0.55, -0.83)

# The slab's camera: place, direction, and the angle of view in degrees.
SLAB_CAMERA = (0.0, -3.0, 2.0)
SLAB_VIEW = (0.0, 3.0, -2.0)
SLAB_ANGLE = 50.0
# Half the slab's width, which fills the picture.
SLAB_SIZE = 40.0

_WHITE = (1.0, 1.0, 1.0)
_LOSSLESS = {
    "CONDUCTOR": {"BaseColor": _WHITE, "EdgeTint": _WHITE},
    "DIELECTRIC": {"Color": _WHITE},
    "DIFFUSE": {"Color": _WHITE},
}


def build_sphere_sun(kind: str) -> None:
    """Build and save the sphere of this kind of material under the sun."""
    scene = _start(samples=256, bounces=0)
    common.add_front_camera(scene)
    common.show_to_camera_only(common.add_unit_sphere(_lossless(kind)))
    add_sun(FRONT_SUN)
    common.save(f"sphere_sun_{kind.lower()}")


def build_furnace(kind: str) -> None:
    """Build and save the sphere of this kind of material in the uniform world."""
    scene = _start(samples=64, bounces=1)
    common.set_world(scene, _WHITE)
    common.add_front_camera(scene)
    common.show_to_camera_only(common.add_unit_sphere(_lossless(kind)))
    common.save(f"furnace_{kind.lower()}")


def build_slab(kind: str) -> None:
    """Build and save the slab of this kind of material under the sun."""
    scene = _start(samples=256, bounces=0)
    mesh = bpy.data.meshes.new("Slab")
    corners = [(SLAB_SIZE * x, SLAB_SIZE * y, 0.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(_lossless(kind))
    common.show_to_camera_only(common.add_object("Slab", mesh))
    common.add_camera(scene, SLAB_CAMERA, SLAB_VIEW, SLAB_ANGLE)
    add_sun(SLAB_SUN)
    common.save(f"slab_{kind.lower()}")


def add_sun(towards: common.Triple) -> None:
    """Add a sun without size whose irradiance on a surface that faces it is 1."""
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = 1.0
    light.angle = 0.0
    common.add_object("Sun", light)
    aim_sun(towards)


def aim_sun(towards: common.Triple) -> None:
    """Move the open fixture's sun: `towards` is the direction to it, of any length."""
    common.aim(bpy.data.objects["Sun"], tuple(-component for component in towards))


def turn_inside_out(inside: bool = True) -> None:
    """Make the normals of the open fixture's sphere point inwards, or outwards again."""
    flip = bpy.data.node_groups[common.SPHERE].nodes[common.INSIDE_OUT]
    flip.inputs["Selection"].default_value = inside


def _start(samples: int, bounces: int) -> bpy.types.Scene:
    scene = common.start_scene((RESOLUTION, RESOLUTION), samples)
    common.use_box_filter(scene)
    common.set_world(scene, (0.0, 0.0, 0.0))
    scene.cycles.max_bounces = bounces
    return scene


def _lossless(kind: str) -> bpy.types.Material:
    return new_material(kind, f"White {kind_named(kind).label}", **_LOSSLESS[kind])
