# SPDX-License-Identifier: GPL-3.0-or-later
"""Links whose values need a formula go through nodes, which the way back takes out again."""

import numpy as np
import pytest

from addon.convert import to_microbounce, to_native
from addon.convert.formula import INSERTED_KEY
from addon.material.node import new_material
from blender_tests.addon.node_trees import (
    DIFFUSE,
    GLOSSY,
    PRINCIPLED,
    dress,
    dump,
    material_with,
)
from blender_tests.addon.support import render, small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")

CLEAR = {"Transmission_Weight": 1.0}
MATTE = {"Specular_IOR_Level": 0.0}
# The type, its values, the input, a value of it, the input of ours, and the nodes before that.
CASES = {
    "glass": (PRINCIPLED, CLEAR, "Base Color", (0.81, 0.49, 0.25, 1.0), "Color", ["GAMMA"]),
    "diffuse": (DIFFUSE, {}, "Roughness", 0.3, "Roughness", ["POWER", "MULTIPLY"]),
    "matte": (PRINCIPLED, MATTE, "Diffuse Roughness", 0.3, "Roughness", ["POWER", "MULTIPLY"]),
    "glossy": (GLOSSY, {"Anisotropy": 0.6}, "Rotation", 0.9, "Rotation", ["ADD", "FRACT"]),
}


@pytest.fixture(params=CASES)
def case(request, empty_file):
    """The type, its values, the input, a value of it, the input of ours, the nodes before that."""
    return CASES[request.param]


def linked(idname, values, name, value):
    """A material of such a node, with a constant that is linked to the input `name`."""
    material, node = material_with(idname, **values)
    tree = material.node_tree
    source = tree.nodes.new("ShaderNodeRGB" if isinstance(value, tuple) else "ShaderNodeValue")
    source.name = "Source"
    source.outputs[0].default_value = value
    tree.links.new(source.outputs[0], node.inputs[name])
    return material, node.name


def inserted(tree):
    return [node for node in tree.nodes if INSERTED_KEY in node]


def test_the_nodes_are_put_in_and_taken_out(case):
    idname, values, name, value, ours, operations = case
    material, node = linked(idname, values, name, value)
    tree = material.node_tree
    dress(material, tree.nodes[node])
    before = dump(tree)
    assert to_microbounce(material).refused == ()
    made = inserted(tree)
    assert [getattr(n, "operation", "GAMMA") for n in made] == operations
    assert tree.nodes[node].inputs[ours].links[0].from_node == made[-1]
    assert made[0].inputs[0].links[0].from_node.name == "Source"
    to_native(material)
    assert dump(tree) == before


def test_a_muted_link_stays_muted(case):
    idname, values, name, value, ours, _ = case
    material, node = linked(idname, values, name, value)
    tree = material.node_tree
    tree.nodes[node].inputs[name].links[0].is_muted = True
    before = dump(tree)
    to_microbounce(material)
    assert tree.nodes[node].inputs[ours].links[0].is_muted
    to_native(material)
    assert dump(tree) == before


def test_a_node_of_ours_that_is_linked_goes_there_and_back(empty_file):
    material = new_material("DIFFUSE", "M")
    tree = material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    (node,) = [n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    tree.links.new(noise.outputs[0], node.inputs["Roughness"])
    before = dump(tree)
    assert len(to_native(material).converted) == 1
    assert [n.operation for n in inserted(tree)] == ["MULTIPLY"]
    to_microbounce(material)
    assert dump(tree) == before


def mute(tree):
    inserted(tree)[0].mute = True


def other_constant(tree):
    inserted(tree)[0].inputs[1].default_value = 0.7


def other_operation(tree):
    inserted(tree)[0].operation = "SUBTRACT"


def no_clamp(tree):
    inserted(tree)[0].use_clamp = False


def animate(tree):
    inserted(tree)[0].inputs[1].keyframe_insert("default_value", frame=1)


def cut(tree):
    tree.links.remove(inserted(tree)[0].inputs[0].links[0])


def own(tree):
    del inserted(tree)[0][INSERTED_KEY]


@pytest.mark.parametrize(
    "change", [mute, other_constant, other_operation, no_clamp, animate, cut, own]
)
def test_nodes_that_were_changed_are_kept(empty_file, change):
    material, node = linked(DIFFUSE, {}, "Roughness", 0.3)
    tree = material.node_tree
    to_microbounce(material)
    names = {n.name for n in inserted(tree)}
    change(tree)
    to_native(material)
    assert names < {n.name for n in tree.nodes}
    (last,) = {n for n in inserted(tree) if n.name not in names}
    assert (last.operation, last.inputs[1].default_value) == ("MULTIPLY", pytest.approx(0.25))
    assert tree.nodes[node].inputs["Roughness"].links[0].from_node == last


def test_nodes_that_feed_something_else_too_are_kept(empty_file):
    material, node = linked(DIFFUSE, {}, "Roughness", 0.3)
    tree = material.node_tree
    to_microbounce(material)
    power, _ = inserted(tree)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(power.outputs[0], mix.inputs[0])
    to_native(material)
    assert tree.nodes[node].inputs["Roughness"].links[0].from_node.name == "Source"
    assert [n.operation for n in inserted(tree)] == ["POWER"]


def test_values_that_no_formula_was_made_for(empty_file):
    from addon.convert.diffuse import _TO_OURS
    from addon.convert.glossy import _QUARTER_LESS

    assert [_TO_OURS(x) for x in (-1.0, 0.0, 1.0, 5.0)] == pytest.approx([0.0, 0.0, 0.8, 0.8])
    assert _QUARTER_LESS(0.1) == pytest.approx(0.85)


def test_the_nodes_compute_what_values_become(tmp_path, case):
    """The picture of a linked constant is that of the same value, also seen by Cycles' node."""
    idname, values, name, value, _, _ = case
    scene, sphere = small_scene(osl=True)
    scene.render.resolution_x = scene.render.resolution_y = 16
    found = []
    fixed, _ = material_with(idname, **values | {name.replace(" ", "_"): value})
    for material in (fixed, linked(idname, values, name, value)[0]):
        assert len(to_microbounce(material).converted) == 1
        sphere.data.materials.clear()
        sphere.data.materials.append(material)
        found.append(render(tmp_path / "picture.exr"))
    np.testing.assert_allclose(*found, atol=1e-4)
    assert found[0].mean() > 0.01
