# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: the native metal without OSL, the script alone with it."""

import math

import numpy as np
import pytest

from blender_tests.addon.support import native_metal, render, small_scene, surface_material

DISTRIBUTIONS = ("MULTI_GGX", "BECKMANN")
FRESNEL = ("F82", "PHYSICAL_CONDUCTOR")

# Of a picture, where a direction takes two ways through 32-bit arithmetic: 2e-7 was measured, and
# 4e-2 for a tangent that is off by one degree.
ROUNDING = 1e-5


def assert_same(picture, expected):
    """Same seed and same closures: the pictures agree in every bit."""
    assert expected.max() > 0.1, "the scene shows nothing"
    difference = np.abs(picture - expected)
    assert np.array_equal(picture, expected), f"differ by up to {difference.max():.3g}"


def relative_error(picture, expected):
    """Root mean square of the difference over that of the expected picture."""
    return np.linalg.norm(picture - expected) / np.linalg.norm(expected)


def with_inputs(material, linked, numbers=(0.3, 0.2, 0.9)):
    """Link a constant vector to socket `linked`, if any, of the material's one surface node."""
    if not linked:
        return material
    tree = material.node_tree
    (node,) = [n for n in tree.nodes if n.bl_idname != "ShaderNodeOutputMaterial"]
    vector = tree.nodes.new("ShaderNodeCombineXYZ")
    for axis, number in enumerate(numbers):
        vector.inputs[axis].default_value = number
    tree.links.new(vector.outputs[0], node.inputs[linked])
    return material


@pytest.mark.parametrize("distribution", [0, 1])
@pytest.mark.parametrize("fresnel", [0, 1])
@pytest.mark.parametrize(
    ("values", "linked"),
    [
        ({"Roughness": 0.7}, ""),
        ({"Roughness": 0.6, "Anisotropy": 0.9, "Rotation": 0.1}, ""),
        ({"Roughness": 0.6, "Anisotropy": 0.9}, "Tangent"),
    ],
    ids=["isotropic", "anisotropic", "tangent"],
)
def test_without_osl_the_native_metal_shows(distribution, fresnel, values, linked, tmp_path):
    from addon.nodes.conductor import conductor_material

    _, sphere = small_scene(osl=False)
    material = conductor_material("Metal", Distribution=distribution, Fresnel=fresnel, **values)
    sphere.data.materials.append(with_inputs(material, linked))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=False)
    native = native_metal("Native", DISTRIBUTIONS[distribution], FRESNEL[fresnel], **values)
    sphere.data.materials.append(with_inputs(native, linked))
    assert_same(picture, render(tmp_path / "native.exr"))


def test_without_osl_a_linked_normal_reaches_the_native_metal(tmp_path):
    from addon.nodes.conductor import conductor_material

    _, sphere = small_scene(osl=False)
    material = conductor_material("Metal", Roughness=0.6)
    sphere.data.materials.append(with_inputs(material, "Normal"))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=False)
    native = native_metal("Native", "MULTI_GGX", "F82", Roughness=0.6)
    sphere.data.materials.append(native)
    plain = render(tmp_path / "plain.exr")
    with_inputs(native, "Normal")
    expected = render(tmp_path / "native.exr")
    assert np.abs(plain - expected).max() > 0.1 * expected.max(), "the normal changes nothing"
    assert_same(picture, expected)


@pytest.mark.parametrize("quality", ["Single", "Walk", "Exact"])
@pytest.mark.parametrize("anisotropy", [0.0, 0.9])
def test_with_osl_only_the_script_counts(quality, anisotropy, tmp_path):
    import bpy

    from addon.nodes.conductor import conductor_group, conductor_material

    values = {"Roughness": 0.8, "Anisotropy": anisotropy, "Quality": quality}
    # A script node by itself does not make Cycles store the coordinates of its default tangent.
    linked = "Tangent" if anisotropy else ""
    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(with_inputs(conductor_material("Metal", **values), linked))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=True)
    (node,) = [n for n in conductor_group().nodes if n.bl_idname == "ShaderNodeScript"]
    material, tree, output = surface_material("Script")
    alone = tree.nodes.new("ShaderNodeScript")
    from addon.nodes.script import fill_script_node

    fill_script_node(alone, node.script.as_string(), node.bytecode, "alone.osl")
    for socket in alone.inputs:
        if socket.identifier in values:
            value = values[socket.identifier]
            socket.default_value = {"Single": 0, "Walk": 2, "Exact": 3}.get(value, value)
    tree.links.new(alone.outputs["BSDF"], output.inputs["Surface"])
    sphere.data.materials.append(with_inputs(material, linked))
    assert bpy.context.scene.cycles.shading_system
    assert_same(picture, render(tmp_path / "script.exr"))


def test_with_osl_the_script_really_runs(tmp_path):
    from addon.nodes.conductor import conductor_material

    pictures = []
    for osl in (True, False):
        _, sphere = small_scene(osl=osl)
        sphere.data.materials.append(
            conductor_material("Metal", Roughness=1.0, Quality="Single", BaseColor=(1, 1, 1))
        )
        pictures.append(render(tmp_path / "picture.exr"))
    # A single bounce at roughness 1 loses about half the light; the native metal keeps it.
    assert pictures[0].mean() < 0.8 * pictures[1].mean()


@pytest.mark.parametrize("socket", ["Normal", "Tangent"])
@pytest.mark.parametrize(
    "numbers",
    [(0.0, 0.0, 0.0), (math.nan, 0.0, 1.0), (math.nan,) * 3, (0.0, math.inf, 0.0)],
    ids=["zero", "nan component", "nan", "infinite"],
)
def test_without_osl_a_vector_that_is_no_direction_means_the_default(socket, numbers, tmp_path):
    from addon.nodes.conductor import conductor_material

    _, sphere = small_scene(osl=False)
    material = conductor_material("Metal", Roughness=0.6, Anisotropy=0.8)
    sphere.data.materials.append(material)
    expected = render(tmp_path / "unlinked.exr")
    with_inputs(material, socket, numbers)
    assert relative_error(render(tmp_path / "linked.exr"), expected) < ROUNDING


def test_with_osl_an_unlinked_tangent_is_cycles_own(tmp_path):
    from addon.nodes.conductor import conductor_material

    values = {"Roughness": 0.6, "Anisotropy": 0.9, "Rotation": 0.1}
    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(conductor_material("Metal", Quality="Single", **values))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(native_metal("Native", "GGX", "F82", **values))
    expected = render(tmp_path / "native.exr")
    # The same closure; its frame is computed in two places.
    assert relative_error(picture, expected) < ROUNDING
