# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the shapes of the showcase: a torus knot, lathed bodies, a cube, a cyclorama."""

import math
from itertools import pairwise

import bmesh
import bpy

Point = tuple[float, float]


def torus_knot(
    name: str, turns: tuple[int, int], radii: tuple[float, float], thickness: float
) -> bpy.types.Curve:
    """Return a tube along a torus knot around Z.

    turns -- times around the axis, and times through the hole
    radii -- of the torus' circle and of its tube
    thickness -- radius of the knot's own tube
    """
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions = "3D"
    curve.twist_mode = "MINIMUM"
    curve.bevel_depth = thickness
    curve.bevel_resolution = 12
    curve.resolution_u = 8
    count = 96
    spline = curve.splines.new("NURBS")
    spline.points.add(count - 1)
    around, through = turns
    for index, point in enumerate(spline.points):
        angle = 2.0 * math.pi * index / count
        distance = radii[0] + radii[1] * math.cos(through * angle)
        point.co = (
            distance * math.cos(around * angle),
            distance * math.sin(around * angle),
            radii[1] * math.sin(through * angle),
            1.0,
        )
    spline.order_u = 4
    spline.use_cyclic_u = True
    spline.use_smooth = True
    return curve


def lathe(name: str, profile: list[Point], segments: int = 48) -> bpy.types.Mesh:
    """Return the smooth surface that the profile (radius, height) sweeps around Z.

    A profile point of radius 0 closes the surface there.
    """
    mesh = bpy.data.meshes.new(name)
    body = bmesh.new()
    rings = []
    for radius, height in profile:
        if radius == 0.0:
            rings.append([body.verts.new((0.0, 0.0, height))])
            continue
        angles = [2.0 * math.pi * index / segments for index in range(segments)]
        rings.append(
            [body.verts.new((radius * math.cos(a), radius * math.sin(a), height)) for a in angles]
        )
    for lower, upper in pairwise(rings):
        for index in range(segments):
            following = (index + 1) % segments
            corners = [
                lower[index % len(lower)],
                lower[following % len(lower)],
                upper[following % len(upper)],
                upper[index % len(upper)],
            ]
            # At a pole, two of the four corners coincide.
            body.faces.new(list(dict.fromkeys(corners)))
    bmesh.ops.recalc_face_normals(body, faces=body.faces)
    _finish(mesh, body)
    return mesh


def cube(name: str, size: float) -> bpy.types.Mesh:
    """Return a cube of this edge length around the origin; a modifier rounds it."""
    mesh = bpy.data.meshes.new(name)
    body = bmesh.new()
    bmesh.ops.create_cube(body, size=size)
    _finish(mesh, body)
    return mesh


def cyclorama(
    name: str, width: float, front: float, back: float, height: float, bend: float
) -> bpy.types.Mesh:
    """Return a floor at z = 0 that bends up into a wall at y = `back`, facing -Y."""
    profile = [(front, 0.0)]
    for index in range(17):
        angle = 0.5 * math.pi * index / 16
        profile.append((back - bend + bend * math.sin(angle), bend - bend * math.cos(angle)))
    profile.append((back, height))
    mesh = bpy.data.meshes.new(name)
    body = bmesh.new()
    left = [body.verts.new((-0.5 * width, y, z)) for y, z in profile]
    right = [body.verts.new((0.5 * width, y, z)) for y, z in profile]
    for index in range(len(profile) - 1):
        body.faces.new((left[index], right[index], right[index + 1], left[index + 1]))
    _finish(mesh, body)
    return mesh


def _finish(mesh: bpy.types.Mesh, body: bmesh.types.BMesh) -> None:
    for face in body.faces:
        face.smooth = True
    body.to_mesh(mesh)
    body.free()
