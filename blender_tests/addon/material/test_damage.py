# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that users have cut at, appended, linked or overridden: what is reused, what is mended."""

import tempfile

import numpy as np
import pytest

from addon.core import VERSION
from addon.core.kinds import KINDS
from addon.core.shader_source import inlined_source
from addon.material.node import new_material
from blender_tests.addon.support import render, small_scene


@pytest.fixture
def group_module(empty_file):
    from addon.material import group

    return group


def script_of(group):
    (script,) = [node for node in group.nodes if node.bl_idname == "ShaderNodeScript"]
    return script


def group_node(material):
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    return node


@pytest.mark.parametrize("lost", ["text", "bytecode", "both"])
def test_deleted_text_or_bytecode_is_put_back_in_place(group_module, kind, empty_file, lost):
    data = empty_file.data
    material = new_material(kind, "Metal")
    group = group_node(material).node_tree
    links = len(group.links)
    bytecode = script_of(group).bytecode
    if lost in ("text", "both"):
        data.texts.remove(data.texts[f"{KINDS[kind].shader}.osl"])
    if lost in ("bytecode", "both"):
        script_of(group).bytecode = ""
    assert group_module.material_group(kind) == group
    script = script_of(group)
    assert script.bytecode == bytecode
    assert script.bytecode_hash
    assert script.script.as_string() == inlined_source(KINDS[kind].shader)
    assert len(group.links) == links
    assert [len(data.node_groups), len(data.texts)] == [1, 1]


def test_deleted_text_changes_no_pixel(kind, tmp_path):
    import bpy

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material(kind, "New", Roughness=0.8))
    expected = render(tmp_path / "whole.exr")
    bpy.data.texts.remove(bpy.data.texts[f"{KINDS[kind].shader}.osl"])
    assert expected.max() > 0.1
    assert np.array_equal(render(tmp_path / "without.exr"), expected)


def remove_socket(group):
    (socket,) = [item for item in group.interface.items_tree if item.name == "Kernel"]
    group.interface.remove(socket)


def remove_script(group):
    group.nodes.remove(script_of(group))


@pytest.mark.parametrize("cut", [remove_socket, remove_script])
def test_group_that_a_user_cut_at_is_left_and_a_whole_one_made(group_module, kind, cut):
    old = group_module.material_group(kind)
    cut(old)
    sockets, nodes = len(old.interface.items_tree), len(old.nodes)
    material = new_material(kind, "Metal", Kernel=0.5)
    assert group_node(material).node_tree != old
    assert group_node(material).inputs["Kernel"].default_value == pytest.approx(0.5)
    assert (len(old.interface.items_tree), len(old.nodes)) == (sockets, nodes)


def libraries(bpy, group_module, kind, tmp_path, names):
    """Write a file with one of our materials for each name; leave an empty file open."""
    for name in names:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        material = new_material(kind, name)
        bpy.data.libraries.write(str(tmp_path / f"{name}.blend"), {material})
    bpy.ops.wm.read_factory_settings(use_empty=True)


def load(bpy, tmp_path, name, **how):
    with bpy.data.libraries.load(str(tmp_path / f"{name}.blend"), **how) as (_, wanted):
        wanted.materials = [name]
    return bpy.data.materials[name]


def test_materials_appended_from_two_files_keep_working_copies(
    group_module, kind, empty_file, tmp_path
):
    bpy = empty_file
    libraries(bpy, group_module, kind, tmp_path, "AB")
    groups = [group_node(load(bpy, tmp_path, name)).node_tree for name in "AB"]
    assert groups[0] != groups[1]
    for group in groups:
        assert group_module.has_bytecode(group)
        assert script_of(group).script is not None
    third = group_node(new_material(kind, "C")).node_tree
    assert third in groups
    assert len(bpy.data.node_groups) == 2


def test_linked_group_is_not_reused(group_module, kind, empty_file, tmp_path):
    bpy = empty_file
    libraries(bpy, group_module, kind, tmp_path, "A")
    linked = group_node(load(bpy, tmp_path, "A", link=True)).node_tree
    assert linked.library is not None
    own = group_node(new_material(kind, "Mine")).node_tree
    assert own.library is None, "the file would not render without the library"
    assert own != linked
    assert group_module.material_group(kind) == own


def test_linked_material_whose_library_is_gone(registered, group_module, kind, tmp_path):
    from addon.scene.exact import uses_exact

    bpy = registered
    libraries(bpy, group_module, kind, tmp_path, "A")
    load(bpy, tmp_path, "A", link=True)
    material = bpy.data.materials["A"].copy()
    material.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "user.blend"))
    (tmp_path / "A.blend").unlink()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "user.blend"))
    (material,) = [m for m in bpy.data.materials if m.library is None]
    assert not uses_exact(material.node_tree)
    assert group_module.material_group(kind).library is None


def test_group_of_another_extension_version_is_told_apart(group_module, kind):
    old = group_module.material_group(kind)
    assert old[group_module.VERSION_KEY] == VERSION
    del old[group_module.STAMP_KEY]
    assert group_module.material_group(kind) != old
    assert old.name == KINDS[kind].name


@pytest.mark.parametrize("name", [None, 12, b"Gold"])
def test_a_name_that_is_no_text_is_refused_before_anything_is_made(
    group_module, kind, empty_file, name
):
    with pytest.raises(TypeError, match=r"The material's name is .*: give a text"):
        new_material(kind, name)
    assert not empty_file.data.node_groups
    assert not empty_file.data.texts


def test_operator_reports_a_full_disk_without_a_compiler(registered, kind, monkeypatch, tmp_path):
    from addon.material import script

    bpy = registered
    obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    monkeypatch.setattr(script, "osl_compiler_available", lambda: False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(RuntimeError, match="gone"):
        bpy.ops.microbounce.add_material(kind=kind)
    assert not bpy.data.materials
    assert not bpy.data.node_groups
    assert not bpy.data.texts
