# SPDX-License-Identifier: GPL-3.0-or-later
"""What is not converted: it stays as it is, and the report says why and what to do."""

import re

import pytest

from addon.convert import TO_NATIVE, TO_OURS, plan, to_microbounce, to_native
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
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")

RED = (1.0, 0.0, 0.0, 1.0)
METAL, CLEAR = {"Metallic": 1.0}, {"Transmission_Weight": 1.0}
VALUES = [
    (GLOSSY, {"distribution": "ASHIKHMIN_SHIRLEY"}, "choose GGX"),
    ("ShaderNodeBsdfRefraction", {}, "use a Glass BSDF"),
    (PRINCIPLED, {}, "a matte surface under a glossy one"),
    (PRINCIPLED, {"Metallic": 0.5}, "Metallic is 0.5: .* Set it to 1"),
    (PRINCIPLED, {"Transmission_Weight": 0.5}, "Transmission Weight is 0.5"),
    (PRINCIPLED, METAL | {"Alpha": 0.5}, "Alpha is 0.5: Microbounce has no transparency"),
    (PRINCIPLED, METAL | {"Coat_Weight": 0.1}, "no coat. Set it to 0"),
    (PRINCIPLED, METAL | {"Sheen_Weight": 0.1}, "no sheen"),
    (PRINCIPLED, METAL | {"Thin_Film_Thickness": 300.0}, "no thin film"),
    (PRINCIPLED, METAL | {"Emission_Strength": 2.0}, "no emission"),
    (PRINCIPLED, CLEAR | {"Specular_Tint": RED}, r"Specular Tint is \(1, 0, 0, 1\)"),
    (
        PRINCIPLED,
        {"Specular_IOR_Level": 0.0, "Subsurface_Weight": 0.3},
        "no subsurface scattering",
    ),
]
LINKED = [
    (GLOSSY, {}, "Anisotropy", "Anisotropy is linked or animated"),
    (PRINCIPLED, METAL, "Metallic", "Metallic is linked or animated"),
    (PRINCIPLED, METAL, "Alpha", "Alpha is linked or animated"),
    (PRINCIPLED, METAL, "Emission Strength", "Emission Strength is linked"),
]


@pytest.fixture(scope="module")
def file():
    """An empty file for all tests here, in which each group is compiled once."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy


def assert_stays(material, words, direction=TO_OURS):
    before = dump(material.node_tree)
    convert = to_microbounce if direction == TO_OURS else to_native
    planned, done = plan(material, direction), convert(material)
    assert planned == done
    (entry,) = done.refused
    assert done.converted == ()
    assert re.search(words, entry.reason), entry.reason
    assert entry.reason in entry.text
    assert dump(material.node_tree) == before


@pytest.mark.parametrize(("idname", "values", "words"), VALUES)
def test_values_without_counterpart(file, idname, values, words):
    material, _ = material_with(idname, **values)
    assert_stays(material, words)


@pytest.mark.parametrize(("idname", "values", "linked", "words"), LINKED)
def test_links_that_cannot_be_carried(file, idname, values, linked, words):
    material, node = material_with(idname, **values)
    dress(material, node, linked)
    assert_stays(material, words)


@pytest.mark.parametrize("idname", [METALLIC, GLASS])
def test_thin_film(file, idname):
    material, node = material_with(idname)
    if "Thin Film Thickness" not in node.inputs:  # Blender 4.5
        assert len(to_microbounce(material).converted) == 1
        return
    node.inputs["Thin Film Thickness"].default_value = 300.0
    assert_stays(material, "no thin film. Set it to 0")


def test_a_metal_may_have_what_does_not_show(file):
    material, _ = material_with(
        PRINCIPLED,
        Metallic=1.0,
        IOR=1.9,
        Transmission_Weight=0.4,
        Subsurface_Weight=0.3,
        Emission_Strength=2.0,
        Emission_Color=(0.0, 0.0, 0.0, 1.0),
    )
    assert len(to_microbounce(material).converted) == 1


def test_animation_that_cannot_be_carried(file):
    for idname, values, name in (
        (DIFFUSE, {}, "Roughness"),
        (GLOSSY, {"Anisotropy": 0.3}, "Rotation"),
        (PRINCIPLED, CLEAR, "Base Color"),
    ):
        material, node = material_with(idname, **values)
        node.inputs[name].keyframe_insert("default_value", frame=1)
        assert_stays(material, f"{name}: animated, which .* cannot take. Remove the animation")
    material, node = material_with(PRINCIPLED, Metallic=1.0)
    node.inputs["IOR"].driver_add("default_value")
    assert_stays(material, "IOR: animated, which Microbounce Conductor cannot take")


OURS = [
    ("CONDUCTOR", "Distribution", "Distribution is linked or animated"),
    ("CONDUCTOR", "Fresnel", "Fresnel is linked or animated"),
    ("DIELECTRIC", "Distribution", "Distribution is linked or animated"),
]


@pytest.mark.parametrize(("kind", "linked", "words"), OURS)
def test_links_of_ours_that_cannot_be_carried(file, kind, linked, words):
    material = new_material(kind, "M")
    tree = material.node_tree
    (node,) = [n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], node.inputs[linked])
    assert_stays(material, words, TO_NATIVE)


def test_a_node_inside_a_users_group_is_named(file):
    group = file.data.node_groups.new("Car Paint", "ShaderNodeTree")
    group.nodes.new(GLASS)
    outer = file.data.node_groups.new("Outer", "ShaderNodeTree")
    for _ in range(2):
        outer.nodes.new("ShaderNodeGroup").node_tree = group
    material, tree, _ = surface_material("Painted")
    tree.nodes.new("ShaderNodeGroup").node_tree = outer
    assert_stays(material, "inside the node group 'Car Paint'.*ungroup it first")


def test_the_nodes_inside_our_own_group_are_ours(file, kind):
    assert plan(new_material(kind, "M")).entries == ()


@pytest.mark.parametrize("missing", ["Roughness", "BSDF"])
def test_a_group_that_lacks_sockets(file, missing):
    material = new_material("CONDUCTOR", "M")
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    group = node.node_tree.copy()
    node.node_tree = group
    group.interface.remove(group.interface.items_tree[missing])
    assert_stays(material, "of another version, or was changed", TO_NATIVE)


def test_a_material_without_nodes(file):
    material = file.data.materials.new("Plain")
    if file.app.version < (5, 0, 0):
        assert not material.use_nodes
        (entry,) = to_microbounce(material).entries
        assert entry.text.endswith("has no nodes: switch Use Nodes on")
        material.use_nodes = True
    material.node_tree.nodes.clear()
    for convert in (to_microbounce, to_native):
        assert convert(material).entries == ()


def test_a_grease_pencil_material(file):
    pencil = file.data.materials.new("Pencil")
    file.data.materials.create_gpencil_data(pencil)
    for direction in (TO_OURS, TO_NATIVE):
        (entry,) = plan(pencil, direction).entries
        assert "grease pencil material, which has no surface: use another" in entry.text


def test_an_empty_group_node(file):
    material, tree, _ = surface_material("Empty")
    tree.nodes.new("ShaderNodeGroup")
    assert plan(material).entries == plan(material, TO_NATIVE).entries == ()


def test_wrong_arguments(file):
    material, _ = material_with(GLASS)
    with pytest.raises(ValueError, match="use TO_OURS or TO_NATIVE"):
        plan(material, "SIDEWAYS")
    for wrong in (None, "Glass", file.data.meshes.new("M")):
        for convert in (plan, to_microbounce, to_native):
            with pytest.raises(TypeError, match="give a bpy"):
                convert(wrong)


def test_a_damaged_installation_changes_nothing(file, monkeypatch):
    from addon import convert
    from addon.core.shader_source import ShaderSourceError

    def broken(kind):
        raise ShaderSourceError("Reinstall the extension")

    material, _ = material_with(GLASS)
    before = dump(material.node_tree)
    monkeypatch.setattr(convert, "material_group", broken)
    with pytest.raises(ShaderSourceError):
        to_microbounce(material)
    assert dump(material.node_tree) == before


def test_linked_and_overridden_materials(empty_file, tmp_path):
    path = tmp_path / "library.blend"
    material, _ = material_with(GLASS)
    material.name = "Library Glass"
    empty_file.data.libraries.write(str(path), {material})
    empty_file.ops.wm.read_factory_settings(use_empty=True)
    with empty_file.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.materials = ["Library Glass"]
    linked = empty_file.data.materials["Library Glass"]
    for direction in (TO_OURS, TO_NATIVE):
        assert_stays(linked, "linked from a library: make it local", direction)
    override = linked.override_create()
    assert_stays(override, "is a library override: make it local")
