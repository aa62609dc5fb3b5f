# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that users have cut at, appended, linked or overridden: what is reused, what is mended."""

import tempfile

import numpy as np
import pytest

from addon.core import VERSION
from addon.core.shader_source import inlined_source
from blender_tests.addon.support import render, small_scene

GROUP = "Microbounce Conductor"


@pytest.fixture
def conductor(empty_file):
    from addon.nodes import conductor

    return conductor


def script_of(group):
    (script,) = [node for node in group.nodes if node.bl_idname == "ShaderNodeScript"]
    return script


def group_node(material):
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    return node


@pytest.mark.parametrize("lost", ["text", "bytecode", "both"])
def test_deleted_text_or_bytecode_is_put_back_in_place(conductor, empty_file, lost):
    data = empty_file.data
    material = conductor.conductor_material("Metal")
    group = group_node(material).node_tree
    links = len(group.links)
    bytecode = script_of(group).bytecode
    if lost in ("text", "both"):
        data.texts.remove(data.texts["microbounce_conductor.osl"])
    if lost in ("bytecode", "both"):
        script_of(group).bytecode = ""
    assert conductor.conductor_group() == group
    script = script_of(group)
    assert script.bytecode == bytecode
    assert script.bytecode_hash
    assert script.script.as_string() == inlined_source(conductor.SHADER_NAME)
    assert len(group.links) == links
    assert [len(data.node_groups), len(data.texts)] == [1, 1]


def test_deleted_text_changes_no_pixel(tmp_path):
    import bpy

    from addon.nodes.conductor import conductor_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(conductor_material("Metal", Roughness=0.8))
    expected = render(tmp_path / "whole.exr")
    bpy.data.texts.remove(bpy.data.texts["microbounce_conductor.osl"])
    assert expected.max() > 0.1
    assert np.array_equal(render(tmp_path / "without.exr"), expected)


def remove_socket(group):
    (socket,) = [item for item in group.interface.items_tree if item.name == "Kernel"]
    group.interface.remove(socket)


def remove_script(group):
    group.nodes.remove(script_of(group))


@pytest.mark.parametrize("cut", [remove_socket, remove_script])
def test_group_that_a_user_cut_at_is_left_and_a_whole_one_made(conductor, cut):
    old = conductor.conductor_group()
    cut(old)
    sockets, nodes = len(old.interface.items_tree), len(old.nodes)
    material = conductor.conductor_material("Metal", Kernel=0.5)
    assert group_node(material).node_tree != old
    assert group_node(material).inputs["Kernel"].default_value == pytest.approx(0.5)
    assert (len(old.interface.items_tree), len(old.nodes)) == (sockets, nodes)


def libraries(bpy, conductor, tmp_path, names):
    """Write a file with one of our materials for each name; leave an empty file open."""
    for name in names:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        material = conductor.conductor_material(name)
        bpy.data.libraries.write(str(tmp_path / f"{name}.blend"), {material})
    bpy.ops.wm.read_factory_settings(use_empty=True)


def load(bpy, tmp_path, name, **how):
    with bpy.data.libraries.load(str(tmp_path / f"{name}.blend"), **how) as (_, wanted):
        wanted.materials = [name]
    return bpy.data.materials[name]


def test_materials_appended_from_two_files_keep_working_copies(conductor, empty_file, tmp_path):
    bpy = empty_file
    libraries(bpy, conductor, tmp_path, "AB")
    groups = [group_node(load(bpy, tmp_path, name)).node_tree for name in "AB"]
    assert groups[0] != groups[1]
    for group in groups:
        assert conductor.has_bytecode(group)
        assert script_of(group).script is not None
    third = group_node(conductor.conductor_material("C")).node_tree
    assert third in groups
    assert len(bpy.data.node_groups) == 2


def test_linked_group_is_not_reused(conductor, empty_file, tmp_path):
    bpy = empty_file
    libraries(bpy, conductor, tmp_path, "A")
    linked = group_node(load(bpy, tmp_path, "A", link=True)).node_tree
    assert linked.library is not None
    own = group_node(conductor.conductor_material("Mine")).node_tree
    assert own.library is None, "the file would not render without the library"
    assert own != linked
    assert conductor.conductor_group() == own


def test_linked_material_whose_library_is_gone(registered, conductor, tmp_path):
    from addon.ops.exact import uses_exact

    bpy = registered
    libraries(bpy, conductor, tmp_path, "A")
    load(bpy, tmp_path, "A", link=True)
    material = bpy.data.materials["A"].copy()
    material.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "user.blend"))
    (tmp_path / "A.blend").unlink()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "user.blend"))
    (material,) = [m for m in bpy.data.materials if m.library is None]
    assert not uses_exact(material.node_tree)
    assert conductor.conductor_group().library is None


def test_group_of_another_extension_version_is_told_apart(conductor):
    old = conductor.conductor_group()
    assert old[conductor.VERSION_KEY] == VERSION
    del old[conductor.STAMP_KEY]
    assert conductor.conductor_group() != old
    assert old.name == GROUP


@pytest.mark.parametrize("name", [None, 12, b"Gold"])
def test_a_name_that_is_no_text_is_refused_before_anything_is_made(conductor, empty_file, name):
    with pytest.raises(TypeError, match=r"The material's name is .*: give a text"):
        conductor.conductor_material(name)
    assert not empty_file.data.node_groups
    assert not empty_file.data.texts


def test_operator_reports_a_full_disk_without_a_compiler(registered, monkeypatch, tmp_path):
    from addon.nodes import script

    bpy = registered
    obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    monkeypatch.setattr(script, "osl_compiler_available", lambda: False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(RuntimeError, match="gone"):
        bpy.ops.microbounce.add_conductor_material()
    assert not bpy.data.materials
    assert not bpy.data.node_groups
    assert not bpy.data.texts
