# SPDX-License-Identifier: GPL-3.0-or-later
"""A converted sphere has the mean colour of the native one, or the report says that it differs."""

import bpy
import numpy as np
import pytest

from addon.convert import to_microbounce
from blender_tests.addon.node_trees import (
    DIFFUSE,
    GLASS,
    GLOSSY,
    METALLIC,
    PRINCIPLED,
    material_with,
)
from blender_tests.addon.support import render, small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")

COLOR = (0.8, 0.5, 0.2, 1.0)

# The type and its values. The mean colours may differ by 2 %: Cycles' own further bounces are
# single ones, scaled.
SAME = 0.02
EXACT = {
    "metal 0.3": (METALLIC, {"Roughness": 0.3}),
    "metal 0.6": (METALLIC, {"Roughness": 0.6}),
    "metal n and k": (METALLIC, {"Roughness": 0.5, "fresnel_type": "PHYSICAL_CONDUCTOR"}),
    "white glossy": (GLOSSY, {"Roughness": 0.5, "Color": (1.0, 1.0, 1.0, 1.0)}),
    "smooth glass": (GLASS, {"Roughness": 0.0}),
    "glass 0.3": (GLASS, {"Roughness": 0.3}),
    "tinted glass": (GLASS, {"Roughness": 0.2, "Color": (0.9, 0.6, 0.3, 1.0)}),
    "matte": (DIFFUSE, {"Color": COLOR}),
    "principled metal": (
        PRINCIPLED,
        {"Metallic": 1.0, "Base_Color": COLOR, "Specular_Tint": (0.9, 0.8, 0.7, 1.0)},
    ),
    "principled glass": (
        PRINCIPLED,
        {"Transmission_Weight": 1.0, "Base_Color": (1.0, 1.0, 1.0, 1.0), "Roughness": 0.3},
    ),
    "principled matte": (PRINCIPLED, {"Specular_IOR_Level": 0.0, "Base_Color": COLOR}),
}
# Here the limit is what was found, rounded up: each differs for the reason that its note gives.
APPROXIMATED = {
    "glossy 0.1": (GLOSSY, {"Roughness": 0.1, "Color": COLOR}, 0.02),
    "glossy 0.5": (GLOSSY, {"Roughness": 0.5, "Color": COLOR}, 0.02),
    "dark glossy": (GLOSSY, {"Roughness": 0.5, "Color": (0.05, 0.3, 0.6, 1.0)}, 0.03),
    "metal 0.9": (METALLIC, {"Roughness": 0.9}, 0.08),
    "anisotropic metal": (METALLIC, {"Roughness": 0.5, "Anisotropy": 0.8}, 0.06),
    "anisotropic glossy": (GLOSSY, {"Anisotropy": 0.5, "Color": (1.0, 1.0, 1.0, 1.0)}, 0.12),
    "glass 0.6": (GLASS, {"Roughness": 0.6}, 0.02),
    "glass 1": (GLASS, {"Roughness": 1.0}, 0.02),
    "matte 0.1": (DIFFUSE, {"Roughness": 0.1, "Color": COLOR}, 0.03),
    "matte 0.25": (DIFFUSE, {"Roughness": 0.25, "Color": COLOR}, 0.05),
    "matte 1": (DIFFUSE, {"Roughness": 1.0, "Color": COLOR}, 0.08),
    "tinted principled glass": (
        PRINCIPLED,
        {"Transmission_Weight": 1.0, "Base_Color": (0.81, 0.49, 0.25, 1.0), "Roughness": 0.3},
        0.15,
    ),
}


@pytest.fixture(scope="module")
def sphere():
    """A sphere that fills the picture, in a world that is brighter above and on one side."""
    scene, sphere = small_scene(True)
    bpy.ops.object.shade_smooth()
    for obj in [obj for obj in bpy.data.objects if obj.type == "LIGHT"]:
        bpy.data.objects.remove(obj)
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = 1.3
    scene.camera.location, scene.camera.rotation_euler = (0, -5, 0), (np.pi / 2, 0, 0)
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces = 64, 16
    cycles.glossy_bounces = cycles.transmission_bounces = 16
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    _light(scene.world)
    return sphere


def _light(world):
    """Make the radiance from direction (x, y, z) 0.6 + 0.3 x + 0.3 z."""
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    # Its map takes seconds. With it, Cycles' own glass of Roughness 0.6 is 7 % brighter.
    world.cycles.sampling_method = "NONE"
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    direction, dot = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeVectorMath")
    dot.operation, dot.inputs[1].default_value = "DOT_PRODUCT", (0.3, 0.0, 0.3)
    add, background = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeBackground")
    add.inputs[1].default_value = 0.6
    links.new(direction.outputs["Generated"], dot.inputs[0])
    links.new(dot.outputs["Value"], add.inputs[0])
    links.new(add.outputs[0], background.inputs["Strength"])
    output = nodes.new("ShaderNodeOutputWorld")
    links.new(background.outputs[0], output.inputs["Surface"])


def picture(sphere, material, folder):
    sphere.data.materials.clear()
    sphere.data.materials.append(material)
    return render(folder / "picture.exr")


def pictures(sphere, folder, idname, values, *qualities):
    """Return the conversion, the native picture, and one after it for each Quality."""
    material, node = material_with(idname, **values)
    name = node.name
    before = picture(sphere, material, folder)
    conversion = to_microbounce(material)
    after = []
    for quality in qualities:
        material.node_tree.nodes[name].inputs["Quality"].default_value = quality
        after.append(picture(sphere, material, folder))
    return conversion, before, *after


def ratio(after, before):
    return after.mean(axis=(0, 1)) / before.mean(axis=(0, 1))


@pytest.mark.parametrize("name", EXACT)
def test_what_is_exact_has_the_same_mean_colour(sphere, tmp_path, report, name):
    conversion, native, fitted = pictures(sphere, tmp_path, *EXACT[name], 1)
    found = ratio(fitted, native)
    report(f"converted {name}", " ".join(f"{r:.4f}" for r in found), f"1 ± {SAME:g}")
    assert not conversion.approximated
    assert np.abs(found - 1.0).max() < SAME


@pytest.mark.parametrize("name", APPROXIMATED)
def test_what_is_approximated_says_so_and_is_near(sphere, tmp_path, report, name):
    *case, limit = APPROXIMATED[name]
    conversion, native, fitted = pictures(sphere, tmp_path, *case, 1)
    found = ratio(fitted, native)
    report(f"converted {name}", " ".join(f"{r:.4f}" for r in found), f"1 ± {limit:g}")
    assert len(conversion.approximated) == 1
    assert np.abs(found - 1.0).max() < limit


# In Single, refraction is not Cycles': its closure has another masking.
SINGLE = {
    "metal GGX": (METALLIC, {"Roughness": 0.7, "distribution": "GGX"}, 0.005),
    "metal Beckmann": (METALLIC, {"Roughness": 0.8, "distribution": "BECKMANN"}, 0.005),
    "glossy along": (
        GLOSSY,
        {"Anisotropy": -0.5, "Rotation": 0.1, "distribution": "GGX", "Color": (1.0, 1.0, 1.0, 1.0)},
        0.005,
    ),
    "glossy across": (
        GLOSSY,
        {"Anisotropy": 0.5, "Rotation": 0.1, "distribution": "GGX", "Color": (1.0, 1.0, 1.0, 1.0)},
        0.005,
    ),
    "glass GGX": (GLASS, {"Roughness": 0.4, "distribution": "GGX"}, 0.02),
    "principled GGX": (
        PRINCIPLED,
        {"Metallic": 1.0, "Anisotropic": 0.7, "Anisotropic_Rotation": 0.2, "distribution": "GGX"},
        0.005,
    ),
}


@pytest.mark.parametrize("name", SINGLE)
def test_one_bounce_is_the_same_in_single_and_more_in_fitted(sphere, tmp_path, report, name):
    idname, values, limit = SINGLE[name]
    conversion, native, single, fitted = pictures(sphere, tmp_path, idname, values, 0, 1)
    found = ratio(single, native)
    shown = " ".join(f"{r:.4f}" for r in found)
    report(f"converted {name}, Single", shown, f"1 ± {limit:g}")
    assert "leaves further bounces out" in conversion.entries[0].notes[-1]
    assert np.abs(found - 1.0).max() < limit
    if idname != GLASS:  # the same closure with the same seed: the same picture
        assert np.abs(single - native).max() < 0.01
    assert ratio(fitted, native).min() > 1.005
