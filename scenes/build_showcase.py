# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds showcase.blend: rough metals in a studio light.

A gold knot (GGX), a brushed steel vase (anisotropic GGX), a copper ball (Beckmann) and a rounded
titanium cube (n and k). Each has its own object index, by which the demo tells them apart.
"""

import math

import bpy

from addon.material.node import new_material

from . import common, shapes

RESOLUTION = (512, 336)

# Parameters by identifier. The colours are the metals' usual reflectances at normal incidence, in
# linear Rec. 709.
METALS = {
    "Gold": {
        "BaseColor": (1.0, 0.766, 0.336),
        "EdgeTint": (1.0, 0.98, 0.88),
        "Roughness": 0.85,
    },
    "Brushed Steel": {
        "BaseColor": (0.669, 0.639, 0.598),
        "EdgeTint": (0.86, 0.87, 0.88),
        "Roughness": 0.7,
        "Anisotropy": 0.9,
        # The brush goes around the vase, so the highlight spreads along its height.
        "Rotation": 0.25,
    },
    "Copper": {
        "BaseColor": (0.955, 0.638, 0.538),
        "EdgeTint": (1.0, 0.93, 0.9),
        "Roughness": 1.0,
        "Distribution": "Beckmann",
    },
    # The defaults of IOR and Extinction are titanium's.
    "Titanium": {"Fresnel": "n and k", "Roughness": 0.8},
}

VASE = [
    (0.0, 0.0),
    (0.42, 0.0),
    (0.47, 0.02),
    (0.52, 0.1),
    (0.66, 0.4),
    (0.74, 0.75),
    (0.72, 1.1),
    (0.58, 1.45),
    (0.38, 1.75),
    (0.27, 2.0),
    (0.25, 2.2),
    (0.3, 2.38),
    (0.4, 2.5),
    (0.425, 2.52),
    (0.41, 2.535),
    (0.37, 2.52),
    (0.27, 2.38),
    (0.22, 2.2),
    (0.23, 2.0),
]

PLINTH = [(0.0, 0.0), (0.97, 0.0), (1.0, 0.03), (1.0, 0.42), (0.97, 0.45), (0.0, 0.45)]


def build() -> None:
    """Build the scene and save it."""
    scene = common.start_scene(RESOLUTION, samples=96)
    scene.cycles.max_bounces = 5
    scene.cycles.diffuse_bounces = 2
    scene.cycles.glossy_bounces = 4
    # Filmic transforms would wash out the metals' hues in the highlights.
    scene.view_settings.view_transform = "Khronos PBR Neutral"
    scene.view_layers[0].use_pass_object_index = True
    _add_gradient_world(scene)
    _add_metals()
    _add_stage()
    _add_lights()
    _add_camera(scene)
    common.save("showcase")


def _add_metals() -> None:
    knot = shapes.torus_knot("Knot", turns=(2, 3), radii=(0.62, 0.3), thickness=0.2)
    _place("Gold Knot", knot, "Gold", (-0.15, 0.35, 1.5), (1.2, 0.0, 0.35))
    vase = shapes.lathe("Vase", VASE)
    _subdivide(_place("Steel Vase", vase, "Brushed Steel", (1.65, 0.7, 0.0), scale=0.86))
    ball = shapes.lathe("Ball", [(0.0, -0.5), *_arc(0.5, 24), (0.0, 0.5)])
    _subdivide(_place("Copper Ball", ball, "Copper", (-1.75, -0.05, 0.5)))
    block = _place(
        "Titanium Cube", shapes.cube("Cube", 0.6), "Titanium", (0.95, -0.85, 0.3), (0.0, 0.0, 0.5)
    )
    bevel = block.modifiers.new("Round", "BEVEL")
    bevel.width, bevel.segments = 0.09, 6


def _add_stage() -> None:
    backdrop = _matte("Backdrop", (0.10, 0.10, 0.11))
    stage = shapes.cyclorama("Cyclorama", width=24.0, front=-9.0, back=5.0, height=9.0, bend=3.0)
    stage.materials.append(backdrop)
    common.add_object("Cyclorama", stage)
    plinth = shapes.lathe("Plinth", PLINTH, segments=96)
    plinth.materials.append(_matte("Plaster", (0.3, 0.285, 0.27)))
    added = common.add_object("Plinth", plinth)
    added.location = (-0.15, 0.35, 0.0)
    added.modifiers.new("Edges", "EDGE_SPLIT").split_angle = 0.5


def _add_lights() -> None:
    for name, location, target, size, watts, color in (
        ("Key", (-3.8, -2.6, 4.4), (0.0, 0.2, 0.9), 1.4, 380.0, (1.0, 0.86, 0.7)),
        ("Rim", (2.2, 3.2, 4.4), (0.2, 0.2, 0.9), 2.4, 420.0, (0.62, 0.78, 1.0)),
        ("Fill", (4.8, -3.6, 1.8), (0.2, 0.0, 0.8), 1.6, 90.0, (0.8, 0.88, 1.0)),
    ):
        light = common.add_area_light(name, location, target, (size, size), watts, "DISK")
        light.color = color


def _add_camera(scene: bpy.types.Scene) -> None:
    data = bpy.data.cameras.new("Camera")
    data.lens = 62.0
    camera = common.add_object("Camera", data)
    camera.location = (0.0, -8.8, 2.3)
    common.aim(camera, (0.03, 8.8, -1.12))
    scene.camera = camera


def _place(
    name: str,
    data: bpy.types.ID,
    metal: str,
    location: common.Triple,
    rotation: common.Triple = (0.0, 0.0, 0.0),
    scale: float = 1.0,
) -> bpy.types.Object:
    data.materials.append(new_material("CONDUCTOR", metal, **METALS[metal]))
    added = common.add_object(name, data)
    added.location = location
    added.rotation_euler = rotation
    added.scale = (scale, scale, scale)
    added.pass_index = 1 + list(METALS).index(metal)
    return added


def _subdivide(target: bpy.types.Object) -> None:
    modifier = target.modifiers.new("Smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = 2


def _arc(radius: float, count: int) -> list[shapes.Point]:
    """Return the points (radius, height) of a half circle between the poles, without them."""
    angles = [math.pi * (index / count - 0.5) for index in range(1, count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def _matte(name: str, color: common.Triple) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*color, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (250, 0)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def _add_gradient_world(scene: bpy.types.Scene) -> None:
    """Surround the scene with a soft gradient, dim below and cool above."""
    common.set_world(scene, (0.0, 0.0, 0.0))
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    coordinates.location = (-800, 0)
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    separate.location = (-600, 0)
    spread = tree.nodes.new("ShaderNodeMapRange")
    spread.location = (-400, 0)
    spread.inputs["From Min"].default_value = -1.0
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.location = (-250, 0)
    ramp.color_ramp.elements[0].color = (0.015, 0.014, 0.015, 1.0)
    ramp.color_ramp.elements[1].color = (0.06, 0.07, 0.1, 1.0)
    tree.links.new(coordinates.outputs["Generated"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], spread.inputs["Value"])
    tree.links.new(spread.outputs["Result"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], background.inputs["Color"])


if __name__ == "__main__":
    build()
