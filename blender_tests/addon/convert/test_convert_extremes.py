# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of nodes with values that no slider reaches, odd names, links and animation."""

import random

import pytest

from addon.convert import TO_NATIVE, TO_OURS, plan, to_microbounce, to_native
from addon.core.kinds import KINDS
from addon.material.group import add_group_node, material_group
from blender_tests.addon.node_trees import DIFFUSE, GLASS, GLOSSY, METALLIC, dump, material_with
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once", "empty_file")

# Where these are not 0, a node is refused.
_WANTED = ("Thin Film Thickness",)
_NUMBERS = (0.0, 1.0, 0.3, -0.7, 2.5, 1e30)


def ours(kind, **values):
    material, tree, output = surface_material("Ours")
    node = add_group_node(tree, material_group(kind))
    for name, value in values.items():
        node.inputs[name].default_value = value
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    return material


@pytest.mark.parametrize("value", [-3, 7])
def test_choices_out_of_range_are_those_that_the_shader_sees(value):
    material = ours("CONDUCTOR", Fresnel=value, Distribution=value, Quality=value)
    before = dump(material.node_tree)
    to_native(material)
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == METALLIC]
    assert node.fresnel_type == ("F82" if value < 0 else "PHYSICAL_CONDUCTOR")
    assert node.distribution == ("GGX" if value < 0 else "BECKMANN")
    to_microbounce(material)
    assert dump(material.node_tree) == before


@pytest.mark.parametrize(("sigma", "wanted"), [(-0.5, 0.0), (9.0, 0.8)])
def test_a_roughness_of_oren_and_nayar_out_of_range(sigma, wanted):
    material, node = material_with(DIFFUSE)
    node.inputs["Roughness"].default_value = sigma
    before = dump(material.node_tree)
    to_microbounce(material)
    (made,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    assert made.inputs["Roughness"].default_value == pytest.approx(wanted)
    to_native(material)
    assert dump(material.node_tree) == before


def disorder(chance, material, node):
    """Set random values on `node`, and link, animate and hide random inputs."""
    tree = material.node_tree
    node.name = "N'\"[0].\u00fc\\"
    for socket in node.inputs:
        value = getattr(socket, "default_value", None)
        if socket.name in _WANTED or isinstance(value, bool):
            continue
        if hasattr(value, "__len__"):
            socket.default_value = [chance.choice(_NUMBERS) for _ in value]
        elif isinstance(value, int):
            socket.default_value = chance.randint(-1, 4)
        else:
            socket.default_value = chance.choice(_NUMBERS)
        way = chance.randrange(10)
        if way == 0:
            source = tree.nodes.new(chance.choice(("ShaderNodeTexNoise", "NodeReroute")))
            tree.links.new(source.outputs[0], socket).is_muted = chance.random() < 0.3
        elif way == 1:
            socket.keyframe_insert("default_value", frame=3)
        elif way == 2:
            socket.hide = True


def test_random_nodes_come_back_as_they_were():
    chance, converted = random.Random(1), 0
    for number in range(150):
        if number % 2:
            material = ours(chance.choice(list(KINDS)))
            there, back, direction = to_native, to_microbounce, TO_NATIVE
            (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
        else:
            material, node = material_with(chance.choice((METALLIC, GLOSSY, GLASS, DIFFUSE)))
            there, back, direction = to_microbounce, to_native, TO_OURS
        disorder(chance, material, node)
        before = dump(material.node_tree)
        planned = plan(material, direction)
        assert dump(material.node_tree) == before, "a plan changes nothing"
        assert there(material) == planned
        if planned.converted:
            converted += 1
            back(material)
        assert dump(material.node_tree) == before
    assert converted > 50
