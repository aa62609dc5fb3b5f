# SPDX-License-Identifier: GPL-3.0-or-later
"""The committed .blend files: current, small, self-contained, and as the oracle assumes."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from addon.nodes.conductor import conductor_group, has_bytecode
from blender_tests.oracle import sphere
from scenes import variants

SCENES = Path(__file__).resolve().parents[2] / "scenes"
NAMES = ("showcase", "furnace_conductor", "sphere_sun_conductor")
FIXTURES = NAMES[1:]


def opened(name: str) -> bpy.types.Scene:
    """Open a scene's file and return its scene."""
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    return bpy.context.scene


@pytest.mark.parametrize("name", NAMES)
def test_file_is_small(name):
    assert (SCENES / f"{name}.blend").stat().st_size < 300 * 1024


@pytest.mark.parametrize("name", NAMES)
def test_file_holds_the_current_shader(name):
    opened(name)
    groups = {metal.node.node_tree for metal in variants.find_metals()}
    assert len(groups) == 1
    group = groups.pop()
    assert has_bytecode(group)
    # It returns the file's own group only where its source and parameters are today's.
    assert conductor_group() == group, "build the scenes anew with 'make scenes'"


@pytest.mark.parametrize("name", NAMES)
def test_file_needs_no_other_file(name):
    opened(name)
    assert not bpy.data.libraries
    assert not [image for image in bpy.data.images if image.source == "FILE"]
    assert not [text for text in bpy.data.texts if text.filepath]
    for group in bpy.data.node_groups:
        for node in group.nodes:
            assert node.bl_idname != "ShaderNodeScript" or node.mode == "INTERNAL"


@pytest.mark.parametrize("name", NAMES)
def test_nothing_biases_the_pixels(name):
    scene = opened(name)
    cycles = scene.cycles
    assert scene.render.engine == "CYCLES"
    assert cycles.shading_system
    assert not cycles.use_denoising
    assert not cycles.use_adaptive_sampling
    assert cycles.sample_clamp_direct == 0.0
    assert cycles.sample_clamp_indirect == 0.0
    assert cycles.light_sampling_threshold == 0.0
    assert cycles.caustics_reflective
    assert cycles.blur_glossy == 0.0


@pytest.mark.parametrize("name", FIXTURES)
def test_camera_is_the_oracles(name):
    scene = opened(name)
    camera = scene.camera
    assert camera.data.type == "ORTHO"
    assert camera.data.ortho_scale == pytest.approx(sphere.CAMERA_WIDTH)
    assert (scene.render.resolution_x, scene.render.resolution_y) == (sphere.RESOLUTION,) * 2
    assert scene.cycles.pixel_filter_type == "BOX"
    assert scene.cycles.filter_width == 1.0
    axes = np.array(camera.matrix_world.to_3x3())
    # Columns: the picture's right and up, and the direction to the viewer; float32 rounding.
    wanted = np.column_stack([(1, 0, 0), (0, 0, 1), sphere.VIEW_DIRECTION])
    np.testing.assert_allclose(axes, wanted, atol=1e-6)


def test_sun_is_the_oracles():
    opened("sphere_sun_conductor")
    sun = bpy.data.objects["Sun"]
    assert sun.data.energy == 1.0
    assert sun.data.angle == 0.0
    towards = np.array(sun.matrix_world.to_3x3())[:, 2]
    np.testing.assert_allclose(towards, sphere.SUN_DIRECTION, atol=1e-6)  # float32 rounding


@pytest.mark.parametrize("name", FIXTURES)
def test_sphere_is_smooth_round_and_of_radius_one(name):
    opened(name)
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.objects["Sphere"].evaluated_get(graph).to_mesh()
    points = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", points.ravel())
    normals = np.empty((len(mesh.corner_normals), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", normals.ravel())
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1.0, atol=1e-6)
    # Means of facet normals lie off the radius by the square of the facets' angle, 0.012 rad.
    np.testing.assert_allclose(normals, points[corners], atol=1e-4)


def test_showcase_tells_its_metals_apart():
    scene = opened("showcase")
    metals = variants.find_metals()
    assert [metal.index for metal in metals] == list(range(1, len(metals) + 1))
    assert len(metals) >= 3
    assert any(metal.get("Anisotropy") > 0 for metal in metals)
    assert any(metal.get("Distribution") == 1 for metal in metals)
    assert scene.view_layers[0].use_pass_object_index
