# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes, pictures as arrays, and runs of Blender in a process of their own."""

import json
import os
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import OpenImageIO

ROOT = Path(__file__).resolve().parents[2]
SIZE = 40
NATIVE = {
    "CONDUCTOR": "ShaderNodeBsdfMetallic",
    "DIELECTRIC": "ShaderNodeBsdfGlass",
    "DIFFUSE": "ShaderNodeBsdfDiffuse",
}

# A child hands back one line of JSON and leaves at once: bpy 4.5 was seen to hang in its tear-down.
_PRELUDE = """
import json, os, sys
import bpy

def finish(result):
    print("RESULT " + json.dumps(result))
    sys.stdout.flush()
    os._exit(0)
"""
_TIMEOUT = 60  # seconds; each of these runs takes about two


def run_blender(
    script: str, folder: Path, environment: dict[str, str] | None = None, modules: bool = True
) -> object:
    """Run `script` in a new Blender and return what it passed to `finish`.

    `folder` takes the script; user files are kept out of the real ones by BLENDER_USER_RESOURCES,
    which points into it unless `environment` sets it. Without `modules` the repository is not on
    the module path, as on a machine that has just the .blend file.
    """
    path = folder / "child.py"
    repository = f"import sys\nsys.path.insert(0, {str(ROOT)!r})\n" if modules else ""
    path.write_text(repository + _PRELUDE + script, encoding="utf-8")
    resources = folder / "resources"
    resources.mkdir(exist_ok=True)
    done = subprocess.run(
        [sys.executable, str(path)],
        env=os.environ | {"BLENDER_USER_RESOURCES": str(resources)} | (environment or {}),
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=_TIMEOUT,
        check=False,
    )
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    assert lines, f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    return json.loads(lines[-1].removeprefix("RESULT "))


def small_scene(osl: bool) -> tuple[bpy.types.Scene, bpy.types.Object]:
    """Empty the file and return a Cycles scene and its sphere, lit from one side; 16 samples.

    The sphere is faceted: Blender 4.5 sums smooth normals in an order that changes from run to
    run, and a last bit of the normal is enough to end a random walk elsewhere.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.shading_system = osl
    cycles.device = "CPU"
    cycles.samples = 16
    cycles.seed = 7
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    sphere = bpy.context.object
    bpy.ops.object.shade_flat()
    bpy.ops.object.camera_add(location=(0, -5, 1), rotation=(1.38, 0, 0))
    scene.camera = bpy.context.object
    bpy.ops.object.light_add(type="AREA", location=(3, -3, 4), rotation=(0.8, 0, 0.8))
    bpy.context.object.data.energy = 600
    world = bpy.data.worlds.new("World")
    scene.world = world
    bpy.context.view_layer.objects.active = sphere
    return scene, sphere


def render(path: Path) -> np.ndarray:
    """Render the current scene to the EXR `path` and return its (SIZE, SIZE, 3) radiances."""
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return read_picture(path)


def read_picture(path: Path) -> np.ndarray:
    """Return the (height, width, 3) float32 radiances of an EXR."""
    source = OpenImageIO.ImageInput.open(str(path))
    assert source is not None, f"{path}: {OpenImageIO.geterror()}"
    pixels = source.read_image(OpenImageIO.FLOAT)
    source.close()
    return np.asarray(pixels, dtype=np.float32)[..., :3]


def surface_material(
    name: str,
) -> tuple[bpy.types.Material, bpy.types.ShaderNodeTree, bpy.types.Node]:
    """Return a material with nothing but an output, its node tree and the output node."""
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def native_material(kind: str, **values: object) -> bpy.types.Material:
    """Return a material of the node of Cycles' own that is the fallback of this kind.

    `values` are the node's sockets by name, and Distribution and Fresnel as numbers.
    """
    material, tree, output = surface_material("Native")
    node = tree.nodes.new(NATIVE[kind])
    distribution, fresnel = values.pop("Distribution", 0), values.pop("Fresnel", 0)
    if kind != "DIFFUSE":
        node.distribution = ("MULTI_GGX", "BECKMANN")[distribution]
    if kind == "CONDUCTOR":
        node.fresnel_type = ("F82", "PHYSICAL_CONDUCTOR")[fresnel]
    for socket, value in values.items():
        node.inputs[socket].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def sphere() -> bpy.types.Object:
    """Return the sphere of `small_scene`, looked up again."""
    return bpy.data.objects["Sphere"]


def give_material(kind: str = "CONDUCTOR", **values: object) -> bpy.types.Material:
    """Give the sphere a new material of ours with these parameters; return it."""
    from addon.material.node import new_material

    material = new_material(kind, "Ours", **values)
    sphere().data.materials.append(material)
    return material
