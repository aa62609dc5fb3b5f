# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds twenty spheres of as many materials, from polished to rough, in memory.

Paths can hit all lights, so Exact renders the truth.
"""

import math
from dataclasses import dataclass, field

import bpy

from addon.material.node import new_material

from . import common, fixtures

_WORLD = (0.5, 0.5, 0.5)
_SUN = (0.4, -0.7, 0.6)  # towards it
_SUN_ANGLE = 1.2  # radians: a wide sun, which Exact hits often, so with little noise
_TEXTURE = 32  # pixels on a side


@dataclass(frozen=True)
class Recipe:
    """A material: its inputs by identifier, and the range of a textured roughness."""

    name: str
    kind: str
    alpha: float
    values: dict[str, object] = field(default_factory=dict)
    textured: tuple[float, float] | None = None


def _metal(name: str, alpha: float, base: common.Triple, **values: object) -> Recipe:
    return Recipe(name, "CONDUCTOR", alpha, {"BaseColor": base, **values})


def _glass(name: str, alpha: float, **values: object) -> Recipe:
    return Recipe(name, "DIELECTRIC", alpha, values)


def _matte(name: str, alpha: float, color: common.Triple, **values: object) -> Recipe:
    return Recipe(name, "DIFFUSE", alpha, {"Color": color, **values})


# The first six are of all kinds, smooth and rough.
RECIPES = (
    _metal("Silver Mirror", 0.01, (0.97, 0.96, 0.92)),
    _metal("Rough Aluminium", 0.75, (0.91, 0.92, 0.92)),
    _glass("Clear Glass", 0.01),
    _glass("Frosted Glass", 0.3),
    _matte("Plaster", 1.0, (0.85, 0.85, 0.83)),
    _metal("Satin Gold", 0.25, (0.95, 0.75, 0.35)),
    _metal("Chrome", 0.04, (0.55, 0.56, 0.56)),
    _metal("Brass", 0.1, (0.91, 0.78, 0.42)),
    _metal(
        "Copper",
        0.2,
        (1.0, 1.0, 1.0),
        Fresnel="n and k",
        IOR=(0.20, 0.92, 1.10),
        Extinction=(3.91, 2.45, 2.14),
    ),
    _metal("Brushed Steel", 0.3, (0.60, 0.59, 0.57), Anisotropy=0.8),
    _metal("Blasted Titanium", 0.5, (0.54, 0.50, 0.45), Distribution="Beckmann"),
    _metal("Cast Iron", 1.0, (0.35, 0.33, 0.32)),
    Recipe("Worn Nickel", "CONDUCTOR", 0.0, {"BaseColor": (0.66, 0.61, 0.53)}, (0.2, 0.75)),
    Recipe("Scuffed Chrome", "CONDUCTOR", 0.0, {"BaseColor": (0.55, 0.56, 0.56)}, (0.05, 0.3)),
    _glass("Satin Glass", 0.1),
    _glass("Beckmann Glass", 0.6, Distribution="Beckmann"),
    _matte("Clay", 0.5, (0.8, 0.5, 0.2)),
    _matte("Paper", 0.2, (0.88, 0.87, 0.85)),
    _matte("Rubber", 1.0, (0.04, 0.04, 0.045)),
    Recipe("Painted Wall", "DIFFUSE", 0.0, {"Color": (0.7, 0.3, 0.25)}, (0.4, 0.9)),
)


def build(count: int = len(RECIPES), resolution: tuple[int, int] = (250, 200)) -> bpy.types.Scene:
    """Empty the file and return a scene of the first `count` materials, all Fitted."""
    scene = common.start_scene(resolution, samples=64)
    common.use_box_filter(scene)
    common.set_world(scene, _WORLD)
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = 6
    fixtures.add_sun(_SUN)
    sun = bpy.data.lights["Sun"]
    sun.angle, sun.energy = _SUN_ANGLE, 3.0
    columns = max(1, round(math.sqrt(count * resolution[0] / resolution[1])))
    rows = math.ceil(count / columns)
    mesh = _sphere()
    for index, recipe in enumerate(RECIPES[:count]):
        thing = common.add_object(recipe.name, mesh.copy())
        thing.data.materials.append(_material(recipe))
        thing.location = (2.2 * (index % columns), 0.0, -2.2 * (index // columns))
    _add_camera(scene, columns, rows, resolution)
    return scene


def _add_camera(
    scene: bpy.types.Scene, columns: int, rows: int, resolution: tuple[int, int]
) -> None:
    camera = common.add_front_camera(scene)
    camera.location.x, camera.location.z = 1.1 * (columns - 1), -1.1 * (rows - 1)
    aspect = resolution[0] / resolution[1]
    camera.data.ortho_scale = max(2.2 * columns, 2.2 * rows * aspect) * max(1.0, 1.0 / aspect)


def _sphere() -> bpy.types.Mesh:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    made = bpy.context.object
    bpy.ops.object.shade_smooth()
    mesh = made.data.copy()
    bpy.data.objects.remove(made)
    return mesh


def _material(recipe: Recipe) -> bpy.types.Material:
    roughness = math.sqrt(recipe.alpha)
    material = new_material(recipe.kind, recipe.name, Roughness=roughness, **recipe.values)
    if recipe.textured:
        _link_texture(material, recipe)
    return material


def _link_texture(material: bpy.types.Material, recipe: Recipe) -> None:
    """Link the roughness to an image that rises from 0 to 1, through a Map Range."""
    image = bpy.data.images.new(recipe.name, _TEXTURE, _TEXTURE, float_buffer=True, is_data=True)
    line = [i / (_TEXTURE - 1) for i in range(_TEXTURE)]
    image.pixels = [part for _ in range(_TEXTURE) for x in line for part in (x, x, x, 1.0)]
    image.pack()
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    texture.interpolation = "Linear"
    spread = tree.nodes.new("ShaderNodeMapRange")
    spread.inputs["To Min"].default_value, spread.inputs["To Max"].default_value = recipe.textured
    group = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeGroup")
    tree.links.new(texture.outputs["Color"], spread.inputs["Value"])
    tree.links.new(spread.outputs[0], group.inputs["Roughness"])
