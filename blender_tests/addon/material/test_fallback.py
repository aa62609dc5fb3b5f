# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: the native material without OSL, the script alone with it."""

import math

import numpy as np
import pytest

from blender_tests.addon.support import native_material, render, small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")

# Oren and Nayar's roughness over ours.
MATTE = 0.25

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


def as_native(kind, values):
    """`values` of our material as sockets of the native one that stands for it."""
    if kind != "DIFFUSE":
        return values
    scaled = {"Roughness": MATTE * values["Roughness"]}
    return {key: value for key, value in values.items() if key in ("Color", "Normal")} | scaled


def pictures(kind, values, tmp_path, linked="", osl=False):
    """Pictures of our material and of the native one with the same values and seed."""
    from addon.material.node import new_material

    found = []
    for make in (
        lambda: new_material(kind, "New", **values),
        lambda: native_material(kind, **as_native(kind, values)),
    ):
        _, sphere = small_scene(osl=osl)
        sphere.data.materials.append(with_inputs(make(), linked))
        found.append(render(tmp_path / "picture.exr"))
    return found


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
    values = values | {"Distribution": distribution, "Fresnel": fresnel}
    assert_same(*pictures("CONDUCTOR", values, tmp_path, linked))


@pytest.mark.parametrize("distribution", [0, 1])
@pytest.mark.parametrize("ior", [0.7, 1.5, 2.4])
def test_without_osl_the_native_glass_shows(distribution, ior, tmp_path):
    values = {"Color": (1.0, 0.5, 0.25, 1.0), "IOR": ior, "Roughness": 0.4}
    assert_same(*pictures("DIELECTRIC", values | {"Distribution": distribution}, tmp_path))


@pytest.mark.parametrize("distribution", [0, 1])
@pytest.mark.parametrize("roughness", [0.0, 0.5, 1.0])
def test_without_osl_the_native_matte_surface_shows(distribution, roughness, tmp_path):
    values = {"Color": (0.9, 0.5, 0.25, 1.0), "Roughness": roughness}
    assert_same(*pictures("DIFFUSE", values | {"Distribution": distribution}, tmp_path))


def test_without_osl_a_linked_normal_reaches_the_native_material(kind, tmp_path):
    values = {"Roughness": 0.6}
    plain, _ = pictures(kind, values, tmp_path)
    picture, expected = pictures(kind, values, tmp_path, "Normal")
    assert np.abs(plain - expected).max() > 0.1 * expected.max(), "the normal changes nothing"
    assert_same(picture, expected)


@pytest.mark.parametrize("osl", [False, True])
def test_the_colour_shows_with_and_without_osl(kind, osl, tmp_path):
    from addon.core.kinds import KINDS
    from addon.material.node import new_material

    color = KINDS[kind].parameters[0].identifier
    scene, sphere = small_scene(osl=osl)
    scene.world = None  # the background is grey
    values = {color: (0.9, 0.45, 0.09), "Roughness": 0.5}
    sphere.data.materials.append(new_material(kind, "New", **values))
    red, green, blue = render(tmp_path / "picture.exr").mean(axis=(0, 1))
    assert red > 0.005, "black"
    # Of bounces and of events in glass each takes the colour once more.
    assert red > 1.5 * green > 3.0 * blue


@pytest.mark.parametrize("quality", ["Single", "Walk", "Exact"])
@pytest.mark.parametrize("anisotropy", [0.0, 0.9])
def test_with_osl_only_the_script_counts(kind, quality, anisotropy, tmp_path):
    import bpy

    from addon.core.kinds import KINDS
    from addon.material.group import material_group
    from addon.material.node import new_material
    from addon.material.script import fill_script_node

    values = {"Roughness": 0.8, "Anisotropy": anisotropy, "Quality": quality}
    # A script node by itself does not make Cycles store the coordinates of its default tangent.
    linked = "Tangent" if anisotropy else ""
    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(with_inputs(new_material(kind, "New", **values), linked))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=True)
    (node,) = [n for n in material_group(kind).nodes if n.bl_idname == "ShaderNodeScript"]
    material, tree, output = surface_material("Script")
    alone = tree.nodes.new("ShaderNodeScript")
    source, parameters = node.script.as_string(), KINDS[kind].parameters
    fill_script_node(alone, parameters, source, node.bytecode, "alone.osl")
    for socket in alone.inputs:
        if socket.identifier in values:
            value = values[socket.identifier]
            socket.default_value = {"Single": 0, "Walk": 2, "Exact": 3}.get(value, value)
    tree.links.new(alone.outputs["BSDF"], output.inputs["Surface"])
    sphere.data.materials.append(with_inputs(material, linked))
    assert bpy.context.scene.cycles.shading_system
    assert_same(picture, render(tmp_path / "script.exr"))


def test_with_osl_the_script_really_runs(kind, tmp_path):
    from addon.material.node import new_material

    pictures = []
    for osl in (True, False):
        scene, sphere = small_scene(osl=osl)
        scene.world = None
        values = {"Roughness": 0.8, "Quality": "Single", "BounceOnly": 2}
        sphere.data.materials.append(new_material(kind, "New", **values))
        pictures.append(render(tmp_path / "picture.exr"))
    # Single has no second bounce to show; Cycles' own material has no such choice.
    assert pictures[0].max() == 0.0
    assert pictures[1].max() > 0.1


@pytest.mark.parametrize("socket", ["Normal", "Tangent"])
@pytest.mark.parametrize(
    "numbers",
    [(0.0, 0.0, 0.0), (math.nan, 0.0, 1.0), (math.nan,) * 3, (0.0, math.inf, 0.0)],
    ids=["zero", "nan component", "nan", "infinite"],
)
def test_without_osl_a_vector_that_is_no_direction_means_the_default(
    kind, socket, numbers, tmp_path
):
    from addon.material.node import new_material

    _, sphere = small_scene(osl=False)
    material = new_material(kind, "New", Roughness=0.6, Anisotropy=0.8)
    sphere.data.materials.append(material)
    expected = render(tmp_path / "unlinked.exr")
    with_inputs(material, socket, numbers)
    assert relative_error(render(tmp_path / "linked.exr"), expected) < ROUNDING


def test_with_osl_an_unlinked_tangent_is_cycles_own(tmp_path):
    from addon.material.node import new_material

    values = {"Roughness": 0.6, "Anisotropy": 0.9, "Rotation": 0.1}
    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material("CONDUCTOR", "Metal", Quality="Single", **values))
    picture = render(tmp_path / "group.exr")

    _, sphere = small_scene(osl=True)
    native = native_material("CONDUCTOR", **values)
    native.node_tree.nodes["Metallic BSDF"].distribution = "GGX"
    sphere.data.materials.append(native)
    expected = render(tmp_path / "native.exr")
    # The same closure; its frame is computed in two places.
    assert relative_error(picture, expected) < ROUNDING
