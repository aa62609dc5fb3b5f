# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets that users save: written, read back, and refused without harm where they are damaged."""

import errno
import os
from pathlib import Path

import pytest

from addon.core.kinds import KINDS
from addon.core.presets import user_files as files
from addon.core.presets.files import PresetError
from blender_tests.addon.operators.test_operators import new_object
from blender_tests.addon.presets.test_apply import holds, our_material, state

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def folder(registered, tmp_path, monkeypatch):
    """The scripts folder, with Blender looking for presets in it alone; an object is active."""
    bpy = registered
    scripts = tmp_path / "scripts ü"

    def user_resource(kind, *, path="", create=False):
        assert kind == "SCRIPTS"
        return str(scripts / path)

    def preset_paths(subdir):
        found = scripts / "presets" / subdir
        return [str(found)] if found.is_dir() else []

    monkeypatch.setattr(bpy.utils, "user_resource", user_resource)
    monkeypatch.setattr(bpy.utils, "preset_paths", preset_paths)
    new_object(bpy, bpy.data.meshes.new("Mesh"))
    return scripts / "presets" / "microbounce"


def shown_node(bpy, kind, **values):
    """Put a material of ours into the active object's only slot; return it and its node."""
    material, node = our_material(kind, **values)
    bpy.context.object.data.materials.clear()
    bpy.context.object.data.materials.append(material)
    return material, node


def test_what_is_saved_is_what_comes_back(registered, folder, kind):
    from addon.material.node import material_node
    from addon.presets.apply import PRESET_KEY
    from addon.presets.user import user_presets

    values = {"Roughness": 0.123, "Distribution": 1, "Quality": 2, "Kernel": 0.05, "Walks": 7}
    _, node = shown_node(registered, kind, **values)
    node["microbounce_preset"] = "conductor/gold"
    ops = registered.ops.microbounce
    assert ops.save_preset(name="My Löwe 2") == {"FINISHED"}
    (path,) = user_presets(kind)
    assert path.parent == folder / kind.lower()
    text = path.read_text(encoding="utf-8")
    assert "Roughness = 0.123\n" in text, "no digits of single precision"
    assert "Normal" not in text
    registered.context.object.data.materials.clear()
    assert ops.apply_user_preset(filepath=str(path)) == {"FINISHED"}
    material = registered.context.object.active_material
    assert material.name == "My Löwe 2"
    copy = material_node(material)
    assert holds(copy, kind, values)
    for socket in node.inputs:
        assert str(copy.inputs[socket.name].default_value) == str(socket.default_value) or tuple(
            copy.inputs[socket.name].default_value
        ) == tuple(socket.default_value)
    assert copy[PRESET_KEY].startswith("user/"), "it is none of the extension's own"


def test_linked_values_are_not_saved(registered, folder, kind):
    material, node = shown_node(registered, kind)
    tree = material.node_tree
    source = tree.nodes.new("ShaderNodeValue")
    tree.links.new(source.outputs[0], node.inputs["Roughness"])
    registered.ops.microbounce.save_preset(name="Linked")
    text = (folder / kind.lower() / "Linked.toml").read_text(encoding="utf-8")
    assert "Roughness" not in text
    assert "Anisotropy" in text


@pytest.mark.parametrize(
    ("name", "words"),
    [("", "give one of letters"), ("  ", "give one of letters"), ("a\nb", "give one of letters")],
)
def test_bad_names_are_refused(registered, folder, name, words):
    shown_node(registered, "CONDUCTOR")
    with pytest.raises(RuntimeError, match=words):
        registered.ops.microbounce.save_preset(name=name)
    assert not folder.exists()


def test_names_cannot_leave_the_folder_and_are_not_taken_twice(registered, folder):
    shown_node(registered, "CONDUCTOR")
    save = registered.ops.microbounce.save_preset
    save(name='../../"evil"')
    (path,) = folder.rglob("*.toml")
    assert path.parent == folder / "conductor"
    assert files.load(path).name == '../../"evil"'
    before = path.read_bytes()
    with pytest.raises(RuntimeError, match="already: choose another name"):
        save(name='../../"evil"')
    assert path.read_bytes() == before


def test_a_folder_that_cannot_be_written_is_named(registered, folder):
    shown_node(registered, "CONDUCTOR")
    folder.parent.mkdir(parents=True)
    folder.write_text("a file is in the way")
    with pytest.raises(RuntimeError, match=r"cannot be written to .* Make the folder writable"):
        registered.ops.microbounce.save_preset(name="Mine")


def test_a_read_only_folder_is_named(registered, folder, monkeypatch):
    def refused(path, mode="r", **_):
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    shown_node(registered, "CONDUCTOR")
    monkeypatch.setattr(Path, "open", refused)  # root may write anywhere
    with pytest.raises(RuntimeError, match=r"Permission denied.* Make the folder writable"):
        registered.ops.microbounce.save_preset(name="Mine")
    assert list(folder.rglob("*.toml")) == []


GOOD = files.preset_text("CONDUCTOR", "Good", {"Roughness": 0.5})
DAMAGED = {
    "code": (b"import os\nos.system('touch here')\n", "is not TOML"),
    "code in a value": (GOOD.replace("0.5", "__import__('os')").encode(), "is not TOML"),
    "empty": (b"", "name is None"),
    "not text": (b"\xff\xfe\x00\x01", "is not UTF-8"),
    "cut off": (GOOD[: len(GOOD) // 2].encode(), "is not TOML|missing"),
    "unknown parameter": (GOOD.replace("Roughness", "Sheen").encode(), "has no 'Sheen'"),
    "out of range": (GOOD.replace("0.5", "7.0").encode(), "it goes from 0 to 1"),
    "not a number": (GOOD.replace("0.5", "nan").encode(), "it goes from 0 to 1"),
    "wrong type": (GOOD.replace("0.5", '"rough"').encode(), "give a number"),
    "too large": (GOOD.encode() + b"#" * 100_000, "is 100.* bytes long and no preset"),
    "nested": (b"a = " + b"[" * 60_000, "nested too deeply|is not TOML"),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_a_damaged_file_is_named_and_the_material_untouched(registered, folder, case):
    content, words = DAMAGED[case]
    material, _ = shown_node(registered, "CONDUCTOR")
    before = state(material)
    path = folder / "conductor" / "bad.toml"
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    with pytest.raises(RuntimeError, match=words) as error:
        registered.ops.microbounce.apply_user_preset(filepath=str(path))
    assert path.name in str(error.value)
    assert state(material) == before
    assert not Path("here").exists()


def test_files_that_are_none_are_refused(registered, folder, tmp_path):
    shown_node(registered, "CONDUCTOR")
    apply = registered.ops.microbounce.apply_user_preset
    with pytest.raises(RuntimeError, match=r"missing.toml: cannot be read"):
        apply(filepath=str(tmp_path / "missing.toml"))
    for path in (tmp_path, "", os.devnull):
        with pytest.raises(RuntimeError, match=r"is no file .* Choose one of the saved presets"):
            apply(filepath=str(path))
    outside = tmp_path / "outside.toml"
    outside.write_text(GOOD)
    with pytest.raises(RuntimeError, match=r"the folder .* is not one of"):
        apply(filepath=str(outside))
    with pytest.raises(RuntimeError, match="not one of the saved presets"):
        registered.ops.microbounce.remove_user_preset(filepath=str(outside))
    assert outside.exists()


@pytest.mark.parametrize("name", ["Löwe", "..", "a/b", "空"])
def test_the_menu_shows_the_name_as_it_was_given(registered, folder, name):
    from addon.operators.user_presets import shown_name
    from addon.presets.user import user_presets

    shown_node(registered, "DIFFUSE")
    registered.ops.microbounce.save_preset(name=name)
    (path,) = user_presets("DIFFUSE")
    assert shown_name(path) == name
    path.write_text("damaged", encoding="utf-8")
    assert shown_name(path) == registered.path.display_name(path.stem, title_case=False)
    path.unlink()
    assert shown_name(path) == registered.path.display_name(path.stem, title_case=False)


def test_a_saved_preset_can_be_removed(registered, folder, kind):
    from addon.presets.user import user_presets

    shown_node(registered, kind)
    ops = registered.ops.microbounce
    for name in ("One", "Two"):
        ops.save_preset(name=name)
    first, second = user_presets(kind)
    assert ops.remove_user_preset(filepath=str(first)) == {"FINISHED"}
    assert user_presets(kind) == [second]


def test_applying_can_be_undone(registered, folder, kind):
    bpy = registered
    bpy.context.preferences.edit.use_global_undo = True
    _, node = shown_node(bpy, kind, Roughness=0.9)
    bpy.ops.microbounce.save_preset(name="Rough")
    node.inputs["Roughness"].default_value = 0.2
    before = state(bpy.data.materials["Ours"])
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.microbounce.apply_user_preset(filepath=str(folder / kind.lower() / "Rough.toml"))
    bpy.ops.ed.undo_push(message="After")
    assert state(bpy.data.materials["Ours"]) != before
    bpy.ops.ed.undo()
    assert state(bpy.data.materials["Ours"]) == before


def test_without_a_node_there_is_nothing_to_save(registered, folder):
    save = registered.ops.microbounce.save_preset
    assert not save.poll()
    with pytest.raises(RuntimeError, match="No Microbounce node feeds the material's output"):
        save(name="Nothing")


def test_text_of_bad_values_is_refused():
    with pytest.raises(PresetError, match="all are linked"):
        files.preset_text("DIFFUSE", "Nothing", {})
    with pytest.raises(ValueError, match="it goes from 0 to 1"):
        files.preset_text("DIFFUSE", "Bright", {"Color": (2.0, 1.0, 1.0)})
    for kind in KINDS:
        labels = {parameter.identifier for parameter in files.saved_parameters(kind)}
        assert labels.isdisjoint({"Normal", "Tangent"})
