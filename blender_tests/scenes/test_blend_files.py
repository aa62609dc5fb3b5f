# SPDX-License-Identifier: GPL-3.0-or-later
"""The committed .blend files are current, small, self-contained, and as the oracle assumes."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from addon.core.kinds import KINDS
from addon.material.group import has_bytecode, material_group
from osl.oracle import slab, sphere
from scenes import fixtures, render, variants

SCENES = Path(__file__).resolve().parents[2] / "scenes"
SPHERES = [f"{scene}_{kind.lower()}" for kind in KINDS for scene in ("furnace", "sphere_sun")]
SUNS = [f"sphere_sun_{kind.lower()}" for kind in KINDS]
FIXTURES = [*SPHERES, "slab_dielectric"]
NAMES = ["showcase", *FIXTURES]
# Error of float32 rotations and positions.
ROUNDING = 1e-6


def opened(name: str) -> bpy.types.Scene:
    """Open a scene's file and return its scene."""
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    return bpy.context.scene


@pytest.mark.parametrize("name", NAMES)
def test_file_is_small(name):
    assert (SCENES / f"{name}.blend").stat().st_size < 512 * 1024


@pytest.mark.parametrize("name", NAMES)
def test_file_holds_the_current_shader(name):
    opened(name)
    kind = "CONDUCTOR" if name == "showcase" else name.rpartition("_")[2].upper()
    (group,) = {material.node.node_tree for material in variants.find_materials()}
    assert has_bytecode(group)
    # It returns the file's own group only if source and parameters are today's.
    assert material_group(kind) == group, "build the scenes anew with 'make scenes'"


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


def test_every_file_is_tested():
    assert {path.stem for path in SCENES.glob("*.blend")} == set(NAMES)


@pytest.mark.parametrize("name", SPHERES)
def test_camera_is_the_oracles(name):
    scene = opened(name)
    camera = scene.camera
    assert camera.data.type == "ORTHO"
    assert camera.data.ortho_scale == pytest.approx(sphere.CAMERA_WIDTH)
    assert (scene.render.resolution_x, scene.render.resolution_y) == (sphere.RESOLUTION,) * 2
    assert scene.cycles.pixel_filter_type == "BOX"
    assert scene.cycles.filter_width == 1.0
    axes = np.array(camera.matrix_world.to_3x3())
    # Columns: right and up in the picture, and the direction to the viewer.
    wanted = np.column_stack([(1, 0, 0), (0, 0, 1), sphere.VIEW_DIRECTION])
    np.testing.assert_allclose(axes, wanted, atol=ROUNDING)


def towards_sun() -> np.ndarray:
    """The unit vector towards the open file's sun. Fails if the sun has a size."""
    bpy.context.view_layer.update()
    sun = bpy.data.objects["Sun"]
    assert sun.data.energy == 1.0
    assert sun.data.angle == 0.0
    return np.array(sun.matrix_world.to_3x3())[:, 2]


@pytest.mark.parametrize("name", SUNS)
def test_sun_is_the_oracles_and_can_be_moved_behind(name):
    opened(name)
    np.testing.assert_allclose(towards_sun(), sphere.FRONT_SUN, atol=ROUNDING)
    fixtures.aim_sun(fixtures.BACK_SUN)
    np.testing.assert_allclose(towards_sun(), sphere.BACK_SUN, atol=ROUNDING)
    assert sphere.BACK_SUN @ sphere.VIEW_DIRECTION < 0.0


@pytest.mark.parametrize("name", FIXTURES)
def test_light_meets_the_surface_once(name):
    scene = opened(name)
    (solid,) = [thing for thing in scene.objects if thing.type == "MESH"]
    assert solid.visible_camera
    others = ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
    assert not [ray for ray in others if getattr(solid, f"visible_{ray}")]
    assert scene.cycles.max_bounces == ("furnace" in name)


@pytest.mark.parametrize("name", SPHERES)
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
    # Means of facet normals are off the radius by the square of the facets' angle, 0.012 rad.
    np.testing.assert_allclose(normals, points[corners], atol=1e-4)


def test_sphere_can_be_turned_inside_out():
    opened("furnace_dielectric")
    for inside, sign in ((True, -1.0), (False, 1.0)):
        fixtures.turn_inside_out(inside)
        graph = bpy.context.evaluated_depsgraph_get()
        mesh = bpy.data.objects["Sphere"].evaluated_get(graph).to_mesh()
        normal = np.array(mesh.corner_normals[1000].vector)
        point = np.array(mesh.vertices[mesh.loops[1000].vertex_index].co)
        np.testing.assert_allclose(normal, sign * point, atol=1e-4)


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("name", [name for name in SPHERES if name.startswith("furnace")])
def test_what_leaves_a_lossless_surface_is_counted_once(name, inside, tmp_path):
    """Exact follows each path to its only exit, so any loss or gain is the scene's."""
    scene = opened(name)
    fixtures.turn_inside_out(inside)
    (material,) = variants.find_materials()
    for identifier, value in {"Roughness": 1.0, "Quality": "Exact", "Tolerance": 0.0}.items():
        material.set(identifier, value)
    material.set("MaxBounces", 64)
    scene.render.resolution_x = scene.render.resolution_y = 16
    passes, _ = render.render_passes(tmp_path / "furnace.exr", 8, 0, tmp_path / "log")
    # Every pixel is a mean of ones in float32. No walk has 64 bounces.
    np.testing.assert_allclose(render.combined(passes), 1.0, atol=1e-5)


def test_light_from_behind_comes_through_glass_alone(tmp_path):
    means = {}
    for kind in KINDS:
        scene = opened(f"sphere_sun_{kind.lower()}")
        fixtures.aim_sun(fixtures.BACK_SUN)
        (material,) = variants.find_materials()
        material.set("Roughness", 0.7)
        scene.render.resolution_x = scene.render.resolution_y = 16
        passes, _ = render.render_passes(tmp_path / "sun.exr", 1024, 0, tmp_path / "log")
        means[kind] = render.combined(passes)[6:10, 6:10].mean()  # facets that face the camera
    assert means["CONDUCTOR"] == means["DIFFUSE"] == 0.0
    assert means["DIELECTRIC"] > 0.05


def test_slab_fills_the_picture_and_is_seen_at_many_angles():
    scene = opened("slab_dielectric")
    plane, camera = bpy.data.objects["Slab"], scene.camera
    corners = [camera.matrix_world @ corner for corner in camera.data.view_frame(scene=scene)]
    eye = camera.matrix_world.translation
    np.testing.assert_allclose(eye, fixtures.SLAB_CAMERA, atol=ROUNDING)
    for corner in corners:
        hit, place, normal, _ = plane.ray_cast(eye, corner - eye)
        assert hit
        np.testing.assert_allclose((*normal, place.z), (0.0, 0.0, 1.0, 0.0), atol=1e-5)
    # The middle column: half the camera's angle above and below its axis.
    down = np.degrees(np.arctan2(-fixtures.SLAB_VIEW[2], fixtures.SLAB_VIEW[1]))
    angles = [90.0 - down - side * fixtures.SLAB_ANGLE / 2 for side in (1, -1)]
    assert angles == pytest.approx([31.3, 81.3], abs=0.1)
    assert np.degrees(camera.data.angle) == pytest.approx(fixtures.SLAB_ANGLE)
    np.testing.assert_allclose(towards_sun(), slab.SUN, atol=ROUNDING)
    assert slab.SUN[2] < 0.0


def test_slabs_camera_is_the_oracles():
    scene = opened("slab_dielectric")
    camera = scene.camera
    axes = np.array(camera.matrix_world.to_3x3())
    up = np.cross([1.0, 0.0, 0.0], slab.CAMERA_DIRECTION)
    wanted = np.column_stack([(1, 0, 0), up, -slab.CAMERA_DIRECTION])
    np.testing.assert_allclose(axes, wanted, atol=ROUNDING)
    assert camera.data.angle == pytest.approx(slab.CAMERA_ANGLE)
    assert (scene.render.resolution_x, scene.render.resolution_y) == (slab.RESOLUTION,) * 2
    assert scene.cycles.pixel_filter_type == "BOX"
    assert scene.cycles.filter_width == 1.0


def test_showcase_tells_its_metals_apart():
    scene = opened("showcase")
    metals = variants.find_materials()
    assert [metal.index for metal in metals] == list(range(1, len(metals) + 1))
    assert len(metals) >= 3
    assert any(metal.get("Anisotropy") > 0 for metal in metals)
    assert any(metal.get("Distribution") == 1 for metal in metals)
    assert scene.view_layers[0].use_pass_object_index
