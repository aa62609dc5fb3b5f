# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the benchmark's scene of two million triangles in memory, because a file is too large.

It shows a wavy sheet of rough metal under a large lamp and a dim sky.
"""

import bpy
import numpy as np

from addon.material.node import new_material

from . import common

RESOLUTION = (128, 80)
SIDE = 1000  # quads, of two triangles each, along a side of the sheet
SIZE = 4.0  # length of a side
# Amplitude, wave number along x and y (rad), phase of each wave.
WAVES = (
    (0.22, 1.3, 0.9, 0.0),
    (0.10, -2.1, 3.4, 1.0),
    (0.045, 7.0, 5.0, 2.0),
    (0.02, -13.0, 17.0, 0.5),
    (0.006, 41.0, 37.0, 1.5),
)
METAL = {"BaseColor": (1.0, 0.766, 0.336), "EdgeTint": (1.0, 0.98, 0.88), "Roughness": 0.8}


def build(side: int = SIDE) -> bpy.types.Scene:
    """Replace the open file by the scene, with 2 `side`^2 triangles, and return it."""
    scene = common.start_scene(RESOLUTION, samples=64)
    scene.cycles.max_bounces = 4
    scene.view_layers[0].use_pass_object_index = True
    common.set_world(scene, (0.05, 0.06, 0.08))
    sheet = common.add_object("Sheet", _sheet(side))
    sheet.data.materials.append(new_material("CONDUCTOR", "Gold", **METAL))
    sheet.pass_index = 1
    common.add_area_light("Lamp", (-2.5, 1.5, 3.0), (0.0, 0.0, 0.0), (2.0, 2.0), 300.0, "DISK")
    common.add_camera(scene, (0.0, -4.2, 2.4), (0.0, 4.2, -2.5), 42.0)
    return scene


def _sheet(side: int) -> bpy.types.Mesh:
    """The displaced sheet with smooth shading."""
    line = np.linspace(-0.5 * SIZE, 0.5 * SIZE, side + 1)
    x, y = np.meshgrid(line, line)
    z = sum(a * np.sin(kx * x + ky * y + phase) for a, kx, ky, phase in WAVES)
    corner = np.arange(side * (side + 1)).reshape(side, side + 1)[:, :-1].ravel()
    right, above, opposite = corner + 1, corner + side + 1, corner + side + 2
    triangles = np.stack([corner, right, opposite, corner, opposite, above], axis=-1).reshape(-1)
    mesh = bpy.data.meshes.new("Sheet")
    mesh.vertices.add(x.size)
    mesh.vertices.foreach_set("co", np.stack([x, y, z], axis=-1).astype(np.float32).ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32))
    count = triangles.size // 3
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(count, dtype=bool))
    mesh.update(calc_edges=True)
    return mesh
