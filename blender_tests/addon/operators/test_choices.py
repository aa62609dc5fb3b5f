# SPDX-License-Identifier: GPL-3.0-or-later
"""Choices are shown by their names, set by them, and taken back."""

from types import SimpleNamespace

import pytest

from addon.core.kinds import KINDS
from blender_tests.addon.operators.test_operators import new_object
from blender_tests.addon.presets.test_apply import our_material
from blender_tests.addon.support import surface_material
from blender_tests.addon.ui.test_panels import Record, draw, node_editor

pytestmark = pytest.mark.usefixtures("compiled_once")

PANELS = ("MICROBOUNCE_PT_material", "MICROBOUNCE_PT_shader_editor")


@pytest.fixture
def shown(registered, kind):
    """Our material on the active object, by its node's inputs; and bpy."""
    new_object(registered, registered.data.meshes.new("Mesh"))
    material, node = our_material(kind)
    registered.context.object.data.materials.append(material)
    return registered, material, node.inputs


def _choices(kind):
    return [parameter for parameter in KINDS[kind].parameters if parameter.choices]


def _drawn(bpy, panel, material):
    space = node_editor(material) if "editor" in panel else SimpleNamespace(type="PROPERTIES")
    return draw(bpy, panel, material=material, space_data=space)


@pytest.mark.parametrize("panel", PANELS)
def test_panels_show_the_names_of_the_values(shown, kind, panel):
    bpy, material, inputs = shown
    wanted = []
    for parameter in _choices(kind):
        inputs[parameter.label].default_value = len(parameter.choices) - 1
        wanted.append(parameter.choices[-1])
    record = _drawn(bpy, panel, material)
    assert record.titles == wanted
    assert {"Beckmann", "Exact", "height-tracked"} <= set(record.titles)
    assert [menu.bl_label for menu in record.menus] == [p.label for p in _choices(kind)]
    assert {parameter.label for parameter in _choices(kind)} <= set(record.texts)


@pytest.mark.parametrize("panel", PANELS)
def test_what_is_linked_cannot_be_chosen(shown, panel):
    bpy, material, inputs = shown
    value = material.node_tree.nodes.new("ShaderNodeValue")
    material.node_tree.links.new(value.outputs[0], inputs["Quality"])
    record = _drawn(bpy, panel, material)
    assert "Quality" not in [menu.bl_label for menu in record.menus]
    assert "Linked" in record.texts
    with pytest.raises(RuntimeError, match="Quality takes what is linked to it: cut the link"):
        bpy.ops.microbounce.set_choice(parameter="Quality", value="Walk")


def test_every_value_of_every_menu_is_set_by_its_name(shown, kind):
    bpy, material, inputs = shown
    for menu in _drawn(bpy, PANELS[0], material).menus:
        record = Record()
        menu.draw(SimpleNamespace(layout=record, parameter=menu.parameter), None)
        assert [button.text for button in record.buttons] == list(menu.parameter.choices)
        for number, button in enumerate(record.buttons):
            arguments = {"parameter": button.parameter, "value": button.value}
            assert bpy.ops.microbounce.set_choice(**arguments) == {"FINISHED"}
            assert inputs[menu.parameter.label].default_value == number


def test_a_choice_is_taken_back(shown):
    bpy, material, inputs = shown
    name, before = material.name, inputs["Quality"].default_value
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.microbounce.set_choice("EXEC_DEFAULT", True, parameter="Quality", value="Exact")
    assert _quality(bpy, name) == 3
    bpy.ops.ed.undo()
    assert _quality(bpy, name) == before


def _quality(bpy, name):
    from addon.material.node import material_node

    return material_node(bpy.data.materials[name]).inputs["Quality"].default_value


def test_wrong_names_are_told(shown):
    bpy = shown[0]
    for arguments, message in (
        ({"parameter": "Quality", "value": "Best"}, "use one of"),
        ({"parameter": "Finesse", "value": "1"}, "has no 'Finesse'"),
        ({"parameter": "Roughness", "value": "0.5"}, "give a number"),
    ):
        with pytest.raises(RuntimeError, match=message):
            bpy.ops.microbounce.set_choice(**arguments)


def test_where_there_is_no_node_of_ours(registered):
    new_object(registered, registered.data.meshes.new("Mesh"))
    other, _, _ = surface_material("Other")
    registered.context.object.data.materials.append(other)
    assert not _drawn(registered, PANELS[0], other).menus
    with pytest.raises(RuntimeError, match="No Microbounce node feeds the material's output"):
        registered.ops.microbounce.set_choice(parameter="Quality", value="Walk")


def test_a_node_of_another_version(shown):
    bpy, material, inputs = shown
    group = inputs["Model"].node.node_tree
    items = group.interface.items_tree
    group.interface.remove(items["Model"])
    items["Quality"].max_value = 9
    quality = inputs["Quality"]
    quality.default_value = 7
    record = _drawn(bpy, PANELS[0], material)
    assert "Model" not in [menu.bl_label for menu in record.menus]
    assert "7" in record.titles
