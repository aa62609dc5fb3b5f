# SPDX-License-Identifier: GPL-3.0-or-later
"""Native nodes become ours and come back as they were, or with what was changed in between."""

import pytest

from addon.convert import TO_NATIVE, plan, to_microbounce, to_native
from addon.convert.formula import INSERTED_KEY
from addon.core.kinds import KINDS
from addon.material.node import new_material
from blender_tests.addon.node_trees import (
    DIFFUSE,
    GLASS,
    GLOSSY,
    METALLIC,
    PRINCIPLED,
    dress,
    dump,
    material_with,
)

pytestmark = pytest.mark.usefixtures("compiled_once")

# The type, its values, the inputs that are linked, and what each becomes on our node.
METAL_LINKS = {
    name: name
    for name in (
        "Base Color",
        "Edge Tint",
        "Roughness",
        "Anisotropy",
        "Rotation",
        "Normal",
        "Tangent",
    )
}
GLASS_LINKS = {name: name for name in ("Color", "Roughness", "IOR", "Normal")}
CASES = {
    "metal F82": (METALLIC, {"Roughness": 0.7, "distribution": "GGX"}, METAL_LINKS, "CONDUCTOR"),
    "metal n and k": (
        METALLIC,
        {"fresnel_type": "PHYSICAL_CONDUCTOR", "distribution": "BECKMANN", "IOR": (0.2, 0.9, 1.1)},
        {name: name for name in ("IOR", "Extinction", "Roughness")},
        "CONDUCTOR",
    ),
    "glossy": (
        GLOSSY,
        {"Color": (0.9, 0.6, 0.3, 1.0), "Anisotropy": 0.4, "Rotation": 0.3},
        {"Color": "Base Color", "Roughness": "Roughness", "Normal": "Normal", "Tangent": "Tangent"},
        "CONDUCTOR",
    ),
    "glossy along": (GLOSSY, {"Anisotropy": -0.4}, {"Rotation": "Rotation"}, "CONDUCTOR"),
    "glass": (GLASS, {"IOR": 1.33, "Roughness": 0.3}, GLASS_LINKS, "DIELECTRIC"),
    "diffuse": (
        DIFFUSE,
        {"Roughness": 0.125, "Color": (0.1, 0.2, 0.3, 1.0)},
        {"Color": "Color", "Roughness": "Roughness", "Normal": "Normal"},
        "DIFFUSE",
    ),
    "principled metal": (
        PRINCIPLED,
        {"Metallic": 1.0, "Coat_Roughness": 0.2, "Anisotropic": 0.6, "distribution": "GGX"},
        {
            "Base Color": "Base Color",
            "Roughness": "Roughness",
            "Specular Tint": "Edge Tint",
            "Anisotropic": "Anisotropy",
            "Anisotropic Rotation": "Rotation",
            "Normal": "Normal",
            "Tangent": "Tangent",
        },
        "CONDUCTOR",
    ),
    "principled glass": (
        PRINCIPLED,
        {"Transmission_Weight": 1.0, "Base_Color": (0.81, 0.49, 0.25, 1.0)},
        {"Base Color": "Color", "Roughness": "Roughness", "IOR": "IOR", "Normal": "Normal"},
        "DIELECTRIC",
    ),
    "principled matte": (
        PRINCIPLED,
        {"Specular_IOR_Level": 0.0, "Diffuse_Roughness": 0.2},
        {"Base Color": "Color", "Diffuse Roughness": "Roughness", "Normal": "Normal"},
        "DIFFUSE",
    ),
}


@pytest.fixture(scope="module")
def file():
    """An empty file for all tests here, in which each group is compiled once."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture(params=CASES)
def case(request, file):
    """A dressed material, its node's name, the links that it shall keep, and the kind of ours."""
    idname, values, links, kind = CASES[request.param]
    material, node = material_with(idname, **values)
    dress(material, node, *links)
    return material, node.name, links, kind


def sources(node):
    return {s.name: source(s) for s in node.inputs if s.is_linked}


def source(socket):
    """The name of the node that a link comes from; those that a conversion put in do not count."""
    node = socket.links[0].from_node
    return source(node.inputs[0]) if INSERTED_KEY in node else node.name


def number(value):
    return pytest.approx(value, abs=1e-6)


def test_a_node_keeps_links_place_and_looks(case):
    material, name, links, kind = case
    old = material.node_tree.nodes[name]
    looks = ("label", "mute", "select", "use_custom_color", "location", "parent")
    before = {key: str(getattr(old, key)) for key in looks}
    conversion = to_microbounce(material)
    node = material.node_tree.nodes[name]
    assert node.node_tree["microbounce_kind"] == kind
    assert [entry.target for entry in conversion.entries] == [KINDS[kind].name]
    assert sources(node) == {new: f"To {old}" for old, new in links.items()}
    assert {key: str(getattr(node, key)) for key in looks} == before
    assert tuple(node.color) == number((0.2, 0.4, 0.6))
    assert node["note"] == "keep me"
    assert material.node_tree.nodes.active == node
    targets = [(link.to_node.bl_idname, link.is_muted) for link in node.outputs["BSDF"].links]
    assert sorted(targets) == [
        ("ShaderNodeMixShader", True),
        ("ShaderNodeOutputMaterial", False),
    ]


def test_there_and_back_is_equal(case):
    material, _, _, _ = case
    before = dump(material.node_tree)
    to_microbounce(material)
    assert dump(material.node_tree) != before
    to_native(material)
    assert dump(material.node_tree) == before


def test_there_and_back_twice_is_equal_on_our_side_too(case):
    material, name, _, _ = case
    to_microbounce(material)
    material.node_tree.nodes[name].inputs["Quality"].default_value = 2
    before = dump(material.node_tree)
    for _ in range(2):
        to_native(material)
        to_microbounce(material)
        after = dump(material.node_tree)
        # The record tells a first conversion from a later one.
        for tree in (before, after):
            tree["nodes"][name]["custom"].pop("microbounce_converted_from", None)
        assert after == before


def test_the_type_returns_after_any_number_of_rounds(case):
    material, name, _, _ = case
    idname = material.node_tree.nodes[name].bl_idname
    to_microbounce(material)
    material.node_tree.nodes[name].inputs["Quality"].default_value = 3
    for _ in range(3):
        to_native(material)
        assert material.node_tree.nodes[name].bl_idname == idname
        to_microbounce(material)
        assert material.node_tree.nodes[name].inputs["Quality"].default_value == 3


def test_a_plan_says_the_same_and_changes_nothing(case):
    material, _, _, _ = case
    before = dump(material.node_tree)
    planned = plan(material)
    assert dump(material.node_tree) == before
    assert to_microbounce(material) == planned
    before = dump(material.node_tree)
    planned = plan(material, TO_NATIVE)
    assert dump(material.node_tree) == before
    assert to_native(material) == planned


VALUES = [
    (METALLIC, {}, {"Fresnel": 0, "Distribution": 0, "Quality": 1}),
    (METALLIC, {"distribution": "BECKMANN"}, {"Distribution": 1, "Quality": 1}),
    (METALLIC, {"fresnel_type": "PHYSICAL_CONDUCTOR"}, {"Fresnel": 1}),
    (METALLIC, {"Roughness": 0.3, "Anisotropy": 0.25}, {"Roughness": 0.3, "Anisotropy": 0.25}),
    # s = 1 - |a|, A = (1 - s^2) / 0.9
    (GLOSSY, {"Anisotropy": -0.4, "Rotation": 0.3}, {"Anisotropy": 0.64 / 0.9, "Rotation": 0.3}),
    (GLOSSY, {"Anisotropy": 0.4, "Rotation": 0.9}, {"Anisotropy": 0.64 / 0.9, "Rotation": 0.15}),
    (GLOSSY, {"Anisotropy": -0.9}, {"Anisotropy": 1.0}),
    (GLOSSY, {"Color": (1.0, 1.0, 1.0, 1.0)}, {"Edge Tint": (1.0, 1.0, 1.0, 1.0)}),
    (GLASS, {"IOR": 2.0, "Roughness": 0.1}, {"IOR": 2.0, "Roughness": 0.1}),
    (GLASS, {"IOR": 500.0}, {"IOR": 100.0}),
    (DIFFUSE, {"Roughness": 0.0}, {"Roughness": 0.0}),
    (DIFFUSE, {"Roughness": 1.0}, {"Roughness": 0.8}),
    (
        PRINCIPLED,
        {"Metallic": 1.0, "Specular_Tint": (0.9, 0.8, 0.7, 1.0), "Anisotropic_Rotation": 0.2},
        {"Edge Tint": (0.9, 0.8, 0.7, 1.0), "Rotation": 0.2},
    ),
    (
        PRINCIPLED,
        {"Transmission_Weight": 1.0, "Base_Color": (0.81, 0.49, 0.25, 1.0)},
        {"Color": (0.9, 0.7, 0.5, 1.0)},
    ),
]


@pytest.mark.parametrize(("idname", "values", "expected"), VALUES)
def test_values_are_translated(file, idname, values, expected):
    material, node = material_with(idname, **values)
    name = node.name
    to_microbounce(material)
    inputs = material.node_tree.nodes[name].inputs
    for label, value in expected.items():
        found = inputs[label].default_value
        assert (tuple(found) if hasattr(found, "__len__") else found) == number(value)


CHANGES = [
    (METALLIC, {}, "Roughness", 0.9, "Roughness", 0.9),
    (METALLIC, {}, "Fresnel", 1, "fresnel_type", "PHYSICAL_CONDUCTOR"),
    (METALLIC, {"distribution": "GGX"}, "Roughness", 0.9, "distribution", "GGX"),
    (METALLIC, {"distribution": "GGX"}, "Distribution", 1, "distribution", "BECKMANN"),
    (METALLIC, {}, "Quality", 0, "distribution", "GGX"),
    (GLOSSY, {}, "Base Color", (0.1, 0.2, 0.3, 1.0), "Color", (0.1, 0.2, 0.3, 1.0)),
    (GLOSSY, {"Anisotropy": 0.4}, "Anisotropy", 0.36 / 0.9, "Anisotropy", 0.2),
    (GLOSSY, {"Anisotropy": -0.4}, "Anisotropy", 0.36 / 0.9, "Anisotropy", -0.2),
    (GLOSSY, {"Anisotropy": 0.4, "Rotation": 0.3}, "Rotation", 0.45, "Rotation", 0.2),
    (GLASS, {}, "IOR", 1.7, "IOR", 1.7),
    (DIFFUSE, {}, "Roughness", 0.8, "Roughness", 0.2),
    (
        PRINCIPLED,
        {"Metallic": 1.0},
        "Edge Tint",
        (0.5, 0.6, 0.7, 1.0),
        "Specular Tint",
        (0.5, 0.6, 0.7, 1.0),
    ),
    (
        PRINCIPLED,
        {"Transmission_Weight": 1.0},
        "Color",
        (0.9, 0.7, 0.5, 1.0),
        "Base Color",
        (0.81, 0.49, 0.25, 1.0),
    ),
]


@pytest.mark.parametrize(("idname", "values", "label", "value", "changed", "expected"), CHANGES)
def test_what_was_changed_on_our_node_returns(
    file, idname, values, label, value, changed, expected
):
    material, node = material_with(idname, **values)
    name = node.name
    before = dump(material.node_tree)["nodes"][name]
    to_microbounce(material)
    material.node_tree.nodes[name].inputs[label].default_value = value
    to_native(material)
    node = material.node_tree.nodes[name]
    assert node.bl_idname == idname
    if changed in ("distribution", "fresnel_type"):
        assert getattr(node, changed) == expected
        return
    found = node.inputs[changed].default_value
    assert (tuple(found) if hasattr(found, "__len__") else found) == number(expected)
    after = dump(material.node_tree)["nodes"][name]
    others = [[s for s in tree["sockets"] if s[0] != changed] for tree in (before, after)]
    assert others[0] == others[1], "the rest is as it was"


def test_what_was_changed_on_the_native_node_comes_back_beside_our_settings(file):
    material = new_material("CONDUCTOR", "M", Quality="Walk", Walks=7, Roughness=0.3)
    (name,) = [n.name for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    to_native(material)
    material.node_tree.nodes[name].inputs["Roughness"].default_value = 0.8
    to_microbounce(material)
    inputs = material.node_tree.nodes[name].inputs
    assert [inputs[key].default_value for key in ("Quality", "Walks")] == [2, 7]
    assert inputs["Roughness"].default_value == number(0.8)


NEAREST = {"CONDUCTOR": METALLIC, "DIELECTRIC": GLASS, "DIFFUSE": DIFFUSE}


def test_our_own_node_becomes_the_nearest_and_returns(file, kind):
    material = new_material(
        kind, "M", Roughness=0.6, Anisotropy=0.2, Quality="Exact", Model=1, MaxBounces=5, Kernel=0.5
    )
    (name,) = [n.name for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    before = dump(material.node_tree)
    conversion = to_native(material)
    assert material.node_tree.nodes[name].bl_idname == NEAREST[kind]
    assert any("Model has no counterpart" in note for note in conversion.entries[0].notes)
    to_microbounce(material)
    assert dump(material.node_tree) == before


@pytest.mark.parametrize(
    ("values", "distribution"),
    [
        ({"Quality": "Single"}, "GGX"),
        ({"Quality": "Fitted"}, "MULTI_GGX"),
        ({"Distribution": "Beckmann"}, "BECKMANN"),
        ({"Distribution": "Beckmann", "Quality": "Single"}, "BECKMANN"),
    ],
)
def test_the_nearest_distribution_is_taken(file, values, distribution):
    material = new_material("CONDUCTOR", "M", **values)
    notes = to_native(material).entries[0].notes
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == METALLIC]
    assert node.distribution == distribution
    assert bool(notes) == (values == {"Distribution": "Beckmann"})


def test_what_the_first_type_cannot_show_becomes_the_nearest(file):
    material, node = material_with(PRINCIPLED, Metallic=1.0)
    name = node.name
    to_microbounce(material)
    material.node_tree.nodes[name].inputs["Fresnel"].default_value = 1
    (entry,) = to_native(material).entries
    assert material.node_tree.nodes[name].bl_idname == METALLIC
    assert material.node_tree.nodes[name].fresnel_type == "PHYSICAL_CONDUCTOR"
    assert "It was a Principled BSDF, which cannot show it any more" in entry.notes[0]


def test_inputs_without_counterpart_keep_their_links(file):
    material, node = material_with(PRINCIPLED, Metallic=1.0)
    tree, name = material.node_tree, node.name
    dress(material, node, "Coat Tint", "Emission Color")
    before = dump(tree)
    conversion = to_microbounce(material)
    assert len(conversion.entries[0].notes) == 2
    assert not sources(tree.nodes[name])
    to_native(material)
    assert dump(tree) == before


def test_a_link_whose_node_is_gone_is_reported(file):
    material, node = material_with(PRINCIPLED, Metallic=1.0)
    tree, name = material.node_tree, node.name
    dress(material, node, "Coat Tint")
    to_microbounce(material)
    tree.nodes.remove(tree.nodes["To Coat Tint"])
    assert (
        "Coat Tint was linked to 'To Coat Tint', which is gone"
        in plan(material, TO_NATIVE).entries[0].notes
    )
    to_native(material)
    assert not sources(tree.nodes[name])


def test_links_of_our_settings_are_kept(file):
    material = new_material("CONDUCTOR", "M")
    tree = material.node_tree
    (node,) = [n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    name = node.name
    value = tree.nodes.new("ShaderNodeValue")
    tree.links.new(value.outputs[0], node.inputs["Walks"])
    before = dump(tree)
    assert "The link to Walks has no counterpart" in to_native(material).entries[0].notes[0]
    to_microbounce(material)
    after = dump(tree)
    for tree in (before, after):
        tree["nodes"][name]["custom"].clear()
    assert after == before


def test_links_made_in_between_go_along(file):
    material, node = material_with(GLASS)
    tree, name = material.node_tree, node.name
    to_microbounce(material)
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs[0], tree.nodes[name].inputs["Roughness"])
    to_native(material)
    assert sources(tree.nodes[name]) == {"Roughness": noise.name}


def test_animation_follows_its_input(file):
    material, node = material_with(METALLIC)
    tree, name = material.node_tree, node.name
    node.inputs["Roughness"].keyframe_insert("default_value", frame=1)
    node.inputs["Base Color"].driver_add("default_value", 1)
    before = dump(tree)
    to_microbounce(material)
    roughness = tree.nodes[name].inputs.find("Roughness")
    paths = dump(tree)["curves"]
    assert f'nodes["{name}"].inputs[{roughness}].default_value' in paths
    assert len(paths) == len(before["curves"]) == 2
    to_native(material)
    assert dump(tree) == before


def test_a_record_that_cannot_be_read_does_no_harm(file):
    for text in ("", "[]", "{}", '{"was": 1}', 3):
        material, node = material_with(GLASS, IOR=1.7)
        node["microbounce_converted_from"] = text
        name = node.name
        to_microbounce(material)
        assert material.node_tree.nodes[name].inputs["IOR"].default_value == number(1.7)


def test_several_nodes_of_a_material(file):
    material, _ = material_with(METALLIC)
    tree = material.node_tree
    for idname in (GLASS, DIFFUSE, METALLIC):
        tree.nodes.new(idname)
    before = dump(tree)
    assert len(to_microbounce(material).converted) == 4
    groups = {n.node_tree for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"}
    assert len(groups) == 3
    assert len(to_native(material).converted) == 4
    assert dump(tree) == before
