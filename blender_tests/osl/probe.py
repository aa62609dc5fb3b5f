# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates functions of the OSL headers for arrays of arguments, through Cycles' emission.

Every set of arguments is stored on one face of a grid; an orthographic camera sees each face in one
pixel, and the shader under test emits what the function returns.
"""

import tempfile
from pathlib import Path

import bpy
import numpy as np
import OpenImageIO as oiio

from addon.core.shader_source import shader_directory
from addon.material.script import compile_source
from scenes import common

COLUMNS = 128
_TYPES = {1: "float", 2: "vector"}
_DATA = {1: "FLOAT", 2: "FLOAT_VECTOR"}
_SOCKETS = {1: "NodeSocketFloat", 2: "NodeSocketVector"}


def evaluate(header: str, statements: str, **arguments: np.ndarray) -> np.ndarray:
    """Return what OSL `statements` assign to the vector `result`, float32 (n, 3), in order.

    `header` is a file of osl/include. `arguments` are arrays (n,), float in OSL, or (n, 3), vector,
    by the name they have in the statements; they arrive as the float32 numbers given here.
    Raises ShaderCompileError, with the compiler's message.
    """
    columns = {name: np.asarray(a, dtype=np.float32) for name, a in arguments.items()}
    count = {len(a) for a in columns.values()}
    if len(count) != 1:
        raise ValueError(f"the arguments differ in length: {sorted(count)}")
    (count,) = count
    bytecode = compile_source(_shader(header, statements, columns))
    # Emission has no sign: positive and negative parts are two pictures.
    with tempfile.TemporaryDirectory() as folder:
        parts = [_render(bytecode, columns, count, sign, Path(folder)) for sign in (1.0, -1.0)]
    return parts[0] - parts[1]


def _shader(header: str, statements: str, columns: dict[str, np.ndarray]) -> str:
    parameters = "".join(f"    {_TYPES[a.ndim]} {name} = 0,\n" for name, a in columns.items())
    return (
        f'#include "{(shader_directory() / "include" / header).as_posix()}"\n'
        f"shader probe(\n{parameters}    float Sign = 1,\n    output color Emission = 0)\n{{\n"
        f"  vector result = 0;\n  {statements}\n"
        "  Emission = color(max(Sign * result, vector(0)));\n}\n"
    )


def _render(
    bytecode: str, columns: dict[str, np.ndarray], count: int, sign: float, folder: Path
) -> np.ndarray:
    rows = max(-(-count // COLUMNS), 4)  # Blender renders no fewer
    scene = common.start_scene((COLUMNS, rows), samples=1)
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.cycles.max_bounces = 0
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    common.set_world(scene, (0.0, 0.0, 0.0))
    material = _material(bytecode, columns, sign)
    common.add_object("Grid", _grid(columns, count, rows, material))
    _add_camera(scene, rows)
    path = folder / "probe.exr"
    scene.render.filepath = str(path)
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.ops.render.render(write_still=True)
    picture = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)[..., :3]
    # The bottom row of the picture is the first of the grid.
    return np.asarray(picture)[::-1].reshape(-1, 3)[:count]


def _grid(
    columns: dict[str, np.ndarray], count: int, rows: int, material: bpy.types.Material
) -> bpy.types.Mesh:
    x, y = np.meshgrid(np.arange(COLUMNS + 1.0), np.arange(rows + 1.0))
    corners = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
    first = np.arange(COLUMNS) + (COLUMNS + 1) * np.arange(rows)[:, None]
    faces = np.stack([first, first + 1, first + COLUMNS + 2, first + COLUMNS + 1], axis=-1)
    mesh = bpy.data.meshes.new("Grid")
    mesh.from_pydata(corners.tolist(), [], faces.reshape(-1, 4).tolist())
    mesh.materials.append(material)
    for name, values in columns.items():
        padded = np.zeros((rows * COLUMNS, *values.shape[1:]), dtype=np.float32)
        padded[:count] = values
        attribute = mesh.attributes.new(name, _DATA[values.ndim], "FACE")
        attribute.data.foreach_set("value" if values.ndim == 1 else "vector", padded.ravel())
    return mesh


def _add_camera(scene: bpy.types.Scene, rows: int) -> None:
    data = bpy.data.cameras.new("Camera")
    data.type = "ORTHO"
    data.ortho_scale = max(COLUMNS, rows)
    camera = common.add_object("Camera", data)
    camera.location = (COLUMNS / 2, rows / 2, 10.0)
    scene.camera = camera


def _material(bytecode: str, columns: dict[str, np.ndarray], sign: float) -> bpy.types.Material:
    material = bpy.data.materials.new("Probe")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    script = tree.nodes.new("ShaderNodeScript")
    script.mode = "EXTERNAL"
    for name, values in columns.items():
        socket = script.inputs.new(_SOCKETS[values.ndim], name, identifier=name)
        source = tree.nodes.new("ShaderNodeAttribute")
        source.attribute_name = name
        tree.links.new(source.outputs["Fac" if values.ndim == 1 else "Vector"], socket)
    script.inputs.new("NodeSocketFloat", "Sign", identifier="Sign").default_value = sign
    script.outputs.new("NodeSocketColor", "Emission", identifier="Emission")
    script.bytecode = bytecode
    script.bytecode_hash = str(hash(bytecode))
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(script.outputs["Emission"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material
