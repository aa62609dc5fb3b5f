# SPDX-License-Identifier: GPL-3.0-or-later
"""A crowd of hard things in a white world: each has a cell of the picture, parameters of its own
and something that makes it hard to shade. All are drawn from a seed; each can be rendered alone."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Euler

from addon.core.kinds import kind_named
from addon.material.node import new_material
from scenes import common

from .linked import group_node, linked_material

COLUMNS = 20
CELL = 8  # pixels on a side
# Half the size of a thing in cells, so that no turn takes it out of its own.
_RADIUS = 0.4
_SHAPES = ("sphere", "coarse sphere", "plane", "slant", "splinter")
_FINISHES = ("linked", "textured", "folded")
_KINDS = ("CONDUCTOR", "DIELECTRIC", "DIFFUSE")
_OWN = ("Quality", "Model", "Distribution", "Roughness", "Anisotropy", "Rotation", "Tangent")
_COLOURS = {"CONDUCTOR": ("BaseColor", "EdgeTint"), "DIELECTRIC": ("Color",), "DIFFUSE": ("Color",)}
# No bounce is left out that a mean would miss.
_ALL = {"MaxBounces": 64, "Tolerance": 0.0}
_DEEPEST = 1e4  # of the slanted planes that span a cell


@dataclass(frozen=True)
class Thing:
    """What is seen in one cell.

    kind     -- of material; `inputs` are its parameters by identifier
    finish   -- linked: parameters are properties of the object; textured: the same, but roughness
                from 0 to 1 and bumps from a texture; folded: parameters are constants
    shape    -- one of _SHAPES, turned inside out where `flipped`; `cosine` to the viewer of a slant
    scale, rotation -- of the instance; `moving` blurs it; `nested` puts another inside
    """

    kind: str
    finish: str
    shape: str
    inputs: dict[str, object]
    flipped: bool
    cosine: float
    scale: tuple[float, float, float]
    rotation: tuple[float, float, float]
    moving: bool
    nested: bool

    @property
    def lossless(self) -> bool:
        """Whether nothing is absorbed."""
        return all(min(self.inputs[name]) == 1.0 for name in _COLOURS[self.kind])

    @property
    def plain(self) -> bool:
        """Whether the shaded normal is that of the geometry, so that no light is sent into it."""
        flat = self.shape in ("plane", "slant")
        own = self.finish == "folded" or (
            self.finish == "linked" and not any(self.inputs["Normal"])
        )
        return flat and own


def draw(count: int, folded: int, seed: int) -> list[Thing]:
    """`count` things, of which `folded` have constant parameters."""
    rng = np.random.default_rng(seed)
    return [_thing(rng, i < folded) for i in range(count)]


def _thing(rng: np.random.Generator, folded: bool) -> Thing:
    kind = str(rng.choice(_KINDS))
    nested = kind == "DIELECTRIC" and rng.random() < 0.3
    return Thing(
        kind=kind,
        finish="folded" if folded else str(rng.choice(_FINISHES[:2])),
        shape="sphere" if nested else str(rng.choice(_SHAPES)),
        inputs=_inputs(rng, kind),
        flipped=bool(rng.random() < 0.3),
        cosine=float(10.0 ** rng.uniform(-4.0, -0.3)),
        scale=tuple(float(s) for s in rng.uniform(0.6, 1.0, 3)),
        rotation=tuple(float(angle) for angle in rng.uniform(0.0, 2.0 * np.pi, 3)),
        moving=bool(rng.random() < 0.3),
        nested=nested,
    )


def _inputs(rng: np.random.Generator, kind: str) -> dict[str, object]:
    """Parameters, with their ends and what is illegal among them."""

    def direction(*hard: tuple[float, float, float]) -> tuple[float, ...]:
        if rng.random() < 0.5:
            return (0.0, 0.0, 0.0)
        chosen = rng.normal(size=3) if rng.random() < 0.5 else hard[rng.integers(len(hard))]
        return tuple(float(component) for component in chosen)

    def some(low: float, high: float, *ends: float) -> float:
        return float(rng.choice(ends) if rng.random() < 0.5 else rng.uniform(low, high))

    inputs = {
        "Quality": int(rng.integers(4)),
        "Model": int(rng.integers(3)),
        "Distribution": int(rng.integers(2)),
        "Roughness": some(0.0, 1.0, 0.0, 0.01, 0.1, 1.0),
        "Anisotropy": some(0.0, 1.0, 0.0, 1.0),
        "Rotation": some(0.0, 1.0, 0.0, 0.25),
        "Tangent": direction((0.0, 0.0, 1.0), (1e-30, 0.0, 0.0), (0.0, 0.0, -1.0)),
        # The viewer is at +z: away from it, along the horizon, and just beyond.
        "Normal": direction((0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.999, 0.0, -0.01)),
    }
    white = rng.random() < 0.7
    for name in _COLOURS[kind]:
        inputs[name] = (1.0, 1.0, 1.0) if white else tuple(rng.uniform(0.0, 1.0, 3).tolist())
    if kind == "DIELECTRIC":
        inputs["IOR"] = some(0.7, 2.5, 1.0, 1.0001, 1.5, 0.2, 5.0)
    return inputs


def build(things: Sequence[Thing]) -> None:
    """The things under a camera that looks down on them; motion blur is on."""
    rows = max(-(-len(things) // COLUMNS), 1)
    scene = common.start_scene((COLUMNS * CELL, rows * CELL), samples=1)
    common.use_box_filter(scene)
    common.set_world(scene, (1.0, 1.0, 1.0))
    scene.cycles.max_bounces = 8
    scene.render.use_motion_blur = True
    scene.render.use_persistent_data = True  # shaders are not compiled again for another seed
    for index, thing in enumerate(things):
        row, column = divmod(index, COLUMNS)
        _add(thing, (column + 0.5, rows - row - 0.5, 0.0), index)
    data = bpy.data.cameras.new("Camera")
    data.type = "ORTHO"
    data.ortho_scale = max(COLUMNS, rows)
    data.clip_end = 3.0 * _DEEPEST
    scene.camera = common.add_object("Camera", data)
    scene.camera.location = (0.5 * COLUMNS, 0.5 * rows, 1.5 * _DEEPEST)


def cells(image: np.ndarray, count: int) -> np.ndarray:
    """Pixels (count, CELL, CELL, 3) of each thing's cell."""
    rows, columns = image.shape[0] // CELL, image.shape[1] // CELL
    split = image.reshape(rows, CELL, columns, CELL, 3).swapaxes(1, 2)
    return split.reshape(rows * columns, CELL, CELL, 3)[:count]


def _add(thing: Thing, place: tuple[float, float, float], index: int) -> None:
    added = common.add_object(f"Thing {index}", _mesh(thing))
    added.location = place
    if thing.shape == "slant":
        deep = _RADIUS * np.sqrt(1.0 / thing.cosine**2 - 1.0)
        added.scale = (_RADIUS, np.hypot(_RADIUS, deep), 1.0)
        added.rotation_euler = (float(np.arctan2(deep, _RADIUS)), 0.0, 0.0)
    else:
        added.scale = [_RADIUS * scale for scale in thing.scale]
        added.rotation_euler = _facing(thing)
    if thing.moving:
        for frame, turn in ((0, -0.1), (2, 0.1)):
            added.rotation_euler.z = turn + thing.rotation[2]
            added.scale.x *= 1.0 - turn
            added.keyframe_insert("rotation_euler", frame=frame)
            added.keyframe_insert("scale", frame=frame)
    added.material_slots[0].link = "OBJECT"
    added.material_slots[0].material = _material(thing, index)
    for name, value in thing.inputs.items():
        added[name] = value
    if thing.nested:
        inner = added.copy()
        bpy.context.scene.collection.objects.link(inner)
        inner.animation_data_clear()
        inner.scale = 0.5 * added.scale
    else:
        common.show_to_camera_only(added)


def _facing(thing: Thing) -> Euler:
    """Any turn, but of flat things one in which the viewer sees them."""
    x, y, z = thing.rotation
    if thing.shape in ("plane", "splinter"):
        x, y = 0.2 * x, 0.2 * y
    return Euler((x, y, z))


def _mesh(thing: Thing) -> bpy.types.Mesh:
    """The mesh of a shape, one for all things of that shape."""
    name = f"{thing.shape}{', flipped' * thing.flipped}"
    if name in bpy.data.meshes:
        return bpy.data.meshes[name]
    mesh = bpy.data.meshes.new(name)
    if "sphere" in thing.shape:
        corners, faces = _sphere(8 if thing.shape == "coarse sphere" else 64)
    else:
        corners = [(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)]
        faces = [(0, 1, 2, 3)]
    if (
        thing.shape == "splinter"
    ):  # a face without area among others, and one so thin that it rounds
        corners += [(-1.0, 0.0, 1e-7), (1.0, 0.0, 1e-7), (1.0, 1e-7, 1e-7)]
        faces += [(4, 5, 5 + 1), (0, 1, 1 + 4)]
    if thing.flipped:
        faces = [face[::-1] for face in faces]
    mesh.from_pydata(corners, [], faces)
    mesh.polygons.foreach_set("use_smooth", [thing.shape != "plane"] * len(faces))
    mesh.materials.append(None)
    return mesh


def _sphere(around: int) -> tuple[list[tuple[float, ...]], list[tuple[int, ...]]]:
    """Corners and faces of a unit sphere, whose poles are rings of no size."""
    half = around // 2
    theta = np.linspace(0.0, np.pi, half + 1)[:, None]
    phi = np.arange(around) * 2.0 * np.pi / around
    z = np.broadcast_to(np.cos(theta), (half + 1, around))
    corners = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), z], axis=-1)
    number = np.arange((half + 1) * around).reshape(half + 1, around)
    following = np.roll(number, -1, axis=1)
    faces = np.stack([number[:-1], number[1:], following[1:], following[:-1]], axis=-1)
    return corners.reshape(-1, 3).tolist(), faces.reshape(-1, 4).tolist()


def _material(thing: Thing, index: int) -> bpy.types.Material:
    if thing.finish == "folded":
        known = kind_named(thing.kind).by_identifier
        fixed = {
            name: known[name].choices[value] if known[name].choices else value
            for name, value in thing.inputs.items()
            if name not in ("Normal", "Tangent")
        }
        return new_material(thing.kind, f"Folded {index}", **fixed, **_ALL)
    name = f"{thing.finish} {thing.kind}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    textured = thing.finish == "textured"
    own = [p for p in thing.inputs if not (textured and p in ("Roughness", "Normal"))]
    material = linked_material(thing.kind, name, own, "OBJECT", **_ALL)
    if textured:
        _add_textures(material)
    return material


def _add_textures(material: bpy.types.Material) -> None:
    """Roughness from 0 to 1 and beyond, and bumps too steep for the surface."""
    tree, node = material.node_tree, group_node(material)
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = 8.0
    steep = tree.nodes.new("ShaderNodeMapRange")
    steep.inputs["From Min"].default_value = 0.35
    steep.inputs["From Max"].default_value = 0.65
    steep.clamp = False
    bump = tree.nodes.new("ShaderNodeBump")
    bump.inputs["Distance"].default_value = 2.0
    tree.links.new(noise.outputs[0], steep.inputs["Value"])
    tree.links.new(steep.outputs[0], node.inputs["Roughness"])
    tree.links.new(noise.outputs[0], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], node.inputs["Normal"])
