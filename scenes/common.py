# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the scripts that build scenes: an empty file, settings, the unit sphere."""

import math
from itertools import pairwise
from pathlib import Path

import bpy
from mathutils import Vector

FOLDER = Path(__file__).resolve().parent
Triple = tuple[float, float, float]

# The sphere's facets span 0.7 degrees. Interpolated normals are then within 1e-4 rad of the
# analytic sphere's, far less than an alpha of 0.01 shows.
SPHERE_SEGMENTS = 512
SPHERE_RINGS = 256
# Names of its node tree, and of the node that flips its faces.
SPHERE = "Unit Sphere"
INSIDE_OUT = "Inside Out"


def start_scene(resolution: tuple[int, int], samples: int) -> bpy.types.Scene:
    """Empty the file and return its scene, set to Cycles with OSL on the CPU.

    Settings that bias pixels are off: clamping, denoiser, adaptive sampling, light threshold.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = resolution
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.shading_system = True
    cycles.samples = samples
    cycles.seed = 0
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = 0.0
    cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = True
    cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    scene.world = bpy.data.worlds.new("World")
    return scene


def use_box_filter(scene: bpy.types.Scene) -> None:
    """Make each pixel the plain mean over its square."""
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1.0


def set_world(scene: bpy.types.Scene, radiance: Triple) -> None:
    """Surround the scene with a uniform radiance. Only paths that leave the scene find it."""
    world = scene.world
    if bpy.app.version < (5, 0, 0):  # later it is always on, and setting it is deprecated
        world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*radiance, 1.0)
    output = tree.nodes.new("ShaderNodeOutputWorld")
    output.location = (250, 0)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    world.cycles.sampling_method = "NONE"


def add_object(name: str, data: bpy.types.ID | None) -> bpy.types.Object:
    """Add an object with this data to the scene."""
    added = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(added)
    return added


def aim(target: bpy.types.Object, direction: Triple) -> None:
    """Turn a camera or light to look along `direction` (any length), with +Z up."""
    target.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()


def add_front_camera(scene: bpy.types.Scene) -> bpy.types.Object:
    """Add the fixtures' camera: orthographic, at (0, -5, 0), looking along +Y, 2.1 units wide."""
    data = bpy.data.cameras.new("Camera")
    data.type = "ORTHO"
    data.ortho_scale = 2.1
    data.clip_end = 20.0
    camera = add_object("Camera", data)
    camera.location = (0.0, -5.0, 0.0)
    aim(camera, (0.0, 1.0, 0.0))
    scene.camera = camera
    return camera


def add_camera(
    scene: bpy.types.Scene, location: Triple, direction: Triple, angle: float
) -> bpy.types.Object:
    """Add a perspective camera whose picture spans `angle` degrees along its longer side."""
    data = bpy.data.cameras.new("Camera")
    data.angle = math.radians(angle)
    camera = add_object("Camera", data)
    camera.location = location
    aim(camera, direction)
    scene.camera = camera
    return camera


def add_area_light(
    name: str,
    location: Triple,
    target: Triple,
    size: tuple[float, float],
    watts: float,
    shape: str = "RECTANGLE",
) -> bpy.types.AreaLight:
    """Add an area light that shines at the point `target`; return its data."""
    light = bpy.data.lights.new(name, "AREA")
    light.shape, light.energy = shape, watts
    light.size, light.size_y = size
    added = add_object(name, light)
    added.location = location
    aim(added, tuple(t - p for t, p in zip(target, location, strict=True)))
    return light


def show_to_camera_only(target: bpy.types.Object) -> None:
    """Let all rays but the camera's pass through, even shadow rays."""
    for ray in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
        setattr(target, f"visible_{ray}", False)


def add_unit_sphere(material: bpy.types.Material) -> bpy.types.Object:
    """Add a smooth unit sphere at the origin, its poles on Z.

    Geometry nodes make it, so such a fine sphere takes no room in the file.
    """
    tree = bpy.data.node_groups.new(SPHERE, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    sphere = tree.nodes.new("GeometryNodeMeshUVSphere")
    sphere.inputs["Segments"].default_value = SPHERE_SEGMENTS
    sphere.inputs["Rings"].default_value = SPHERE_RINGS
    sphere.inputs["Radius"].default_value = 1.0
    flip = tree.nodes.new("GeometryNodeFlipFaces")
    flip.name = flip.label = INSIDE_OUT
    flip.inputs["Selection"].default_value = False
    smooth = tree.nodes.new("GeometryNodeSetShadeSmooth")
    assign = tree.nodes.new("GeometryNodeSetMaterial")
    assign.inputs["Material"].default_value = material
    output = tree.nodes.new("NodeGroupOutput")
    chain = (sphere, flip, smooth, assign, output)
    for index, (first, second) in enumerate(pairwise(chain)):
        tree.links.new(first.outputs[0], second.inputs[0])
        second.location = (200 * (index + 1), 0)
    mesh = bpy.data.meshes.new("Sphere")
    mesh.materials.append(material)
    added = add_object("Sphere", mesh)
    added.modifiers.new(SPHERE, "NODES").node_group = tree
    return added


def save(name: str) -> Path:
    """Save the file as scenes/`name`.blend, compressed, without a trace of this machine."""
    path = FOLDER / f"{name}.blend"
    bpy.context.scene.render.filepath = f"//../build/{name}"
    for screen in bpy.data.screens:
        for space in (space for area in screen.areas for space in area.spaces):
            if space.type == "FILE_BROWSER" and space.params:
                space.params.directory = b"//"  # initially the user's home
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, relative_remap=True)
    print(f"{path.name}: {path.stat().st_size / 1024:.0f} KB")
    return path
