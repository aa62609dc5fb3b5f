# SPDX-License-Identifier: GPL-3.0-or-later
"""Subcommands that list presets and that change files: nothing is saved unless that was asked."""

import json

import pytest

from addon.core.presets.catalogue import finishes, presets
from addon.core.presets.user_files import preset_text
from blender_tests.addon.support import native_material, small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def file(registered, tmp_path):
    """A saved file with our matte material "Ours" and Cycles' metal "Native"."""
    from addon.material.node import new_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material("DIFFUSE", "Ours"))
    sphere.data.materials.append(native_material("CONDUCTOR", Roughness=0.4))
    path = tmp_path / "scene.blend"
    registered.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def node_kinds(bpy, path, material):
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return sorted(
        node.node_tree.get("microbounce_kind", "") if node.type == "GROUP" else node.type
        for node in bpy.data.materials[material].node_tree.nodes
        if node.type != "OUTPUT_MATERIAL"
    )


def test_presets_are_listed_and_searched(command):
    code, out, _ = command("presets", "--json")
    assert code == 0
    listed = [item for item in json.loads(out)["presets"] if not item["own"]]
    assert len(listed) == len(presets()) + len(finishes())
    gold = next(item for item in listed if item["identifier"] == "conductor/gold")
    assert gold["kinds"] == ["CONDUCTOR"]
    assert gold["source"]["licence"] == "CC0-1.0"
    assert len(gold["values"]["BaseColor"]) == 3
    code, out, _ = command("presets", "--kind", "conductor", "--search", "GOLD")
    assert code == 0
    assert "conductor/gold" in out
    assert all(line.startswith("conductor/") for line in out.splitlines())
    _, out, _ = command("presets", "--kind", "finish")
    assert all(line.startswith("finish/") for line in out.splitlines())
    assert len(out.splitlines()) == len(finishes())
    code, out, _ = command("presets", "--search", "no such thing")
    assert (code, out) == (1, "No preset is like that: search for less\n")


def test_a_damaged_preset_is_an_error(command, monkeypatch, tmp_path):
    from addon.core.presets import catalogue as library

    (tmp_path / "conductor").mkdir()
    (tmp_path / "conductor" / "bad.toml").write_text("name = ", encoding="utf-8")
    monkeypatch.setattr(library, "FOLDER", tmp_path)
    code, _, err = command("presets")
    assert code == 2
    assert "bad.toml" in err


@pytest.mark.parametrize("name", ["conductor/gold", "gold", "Gold"])
def test_a_preset_is_applied_and_saved_as_another_file(command, file, registered, name):
    before = file.read_bytes()
    target = file.with_name("gold.blend")
    arguments = ("preset", name, "--material", "Ours", "--finish", "brushed", "--file", file)
    code, out, _ = command(*arguments, "--save-as", target, "--json")
    assert code == 0
    result = json.loads(out)
    assert (result["preset"], result["finish"]) == ("conductor/gold", "finish/brushed")
    assert (result["saved"], result["left"]) == (str(target), [])
    assert "CONDUCTOR" in node_kinds(registered, target, "Ours")
    assert file.read_bytes() == before
    assert command(*arguments, "--save-as", target)[0] == 2, "never overwrites silently"


@pytest.fixture
def own(registered, tmp_path, monkeypatch):
    """The folder of the user's presets, with a metal in it that is called "My Gold"."""
    folder = tmp_path / "presets"
    path = folder / "microbounce" / "conductor" / "My_Gold.toml"
    path.parent.mkdir(parents=True)
    path.write_text(preset_text("CONDUCTOR", "My Gold", {"Roughness": 0.75}), encoding="utf-8")

    def preset_paths(subdir):
        return [str(folder / subdir)] if (folder / subdir).is_dir() else []

    monkeypatch.setattr(registered.utils, "preset_paths", preset_paths)
    return path


def test_the_users_own_presets_are_listed_and_marked(command, own):
    code, out, _ = command("presets", "--json")
    result = json.loads(out)
    assert (code, result["left_out"]) == (0, [])
    (mine,) = [item for item in result["presets"] if item["own"]]
    assert (mine["identifier"], mine["kinds"]) == ("user/conductor/My_Gold", ["CONDUCTOR"])
    code, out, _ = command("presets", "--kind", "conductor", "--search", "my gold")
    assert (code, out) == (0, "user/conductor/My_Gold  My Gold: Saved by a user\n")
    assert command("presets", "--kind", "finish", "--search", "my gold")[0] == 1


@pytest.mark.parametrize("name", ["user/conductor/My_Gold", "my_gold", "My Gold"])
def test_one_of_the_users_own_is_applied(command, file, own, registered, name):
    argv = ("preset", name, "--material", "Ours", "--file", file, "--save", "--json")
    code, out, _ = command(*argv)
    assert (code, json.loads(out)["preset"]) == (0, "user/conductor/My_Gold")
    assert "CONDUCTOR" in node_kinds(registered, file, "Ours")
    own.write_text(own.read_text(encoding="utf-8").replace("My Gold", "Gold"), encoding="utf-8")
    _, _, err = command("preset", "gold", "--material", "Ours", "--file", file)
    assert "use one of conductor/gold, user/conductor/My_Gold" in err


def test_a_damaged_one_of_the_users_is_named_and_the_others_stay(command, file, own):
    own.write_text("damaged", encoding="utf-8")
    code, out, _ = command("presets")
    assert code == 1
    assert f"Left out: {own}: is not TOML" in out
    code, out, _ = command("presets", "--json")
    result = json.loads(out)
    assert len(result["presets"]) == len(presets()) + len(finishes())
    assert len(result["left_out"]) == 1
    code, _, err = command("preset", "my_gold", "--material", "Ours", "--file", file)
    assert code == 2
    assert f"Left out: {own}: is not TOML" in err
    assert command("preset", "gold", "--material", "Ours", "--file", file)[0] == 0


def test_without_save_nothing_is_saved(command, file):
    before = {path: path.read_bytes() for path in file.parent.iterdir()}
    code, out, _ = command("preset", "gold", "--material", "Ours", "--file", file)
    assert code == 0
    assert "Nothing was saved: add --save or --save-as FILE" in out
    assert command("convert", "--to", "microbounce", "--file", file)[0] == 0
    assert {path: path.read_bytes() for path in file.parent.iterdir()} == before


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (("gould", "--material", "Ours"), "There is no preset 'gould': did you mean"),
        (("qqqqqq", "--material", "Ours"), "`presets` lists what there is"),
        (("gold", "--material", "Our"), "There is no material 'Our': use one of Ours"),
        (("gold", "--material", "Ours", "--finish", "brush"), "did you mean brushed"),
        (("water", "--material", "Ours", "--finish", "brushed"), "choose another finish"),
        (("gold", "--material", "Ours", "--save-as", "there/new.blend"), "does not exist"),
    ],
)
def test_names_that_are_wrong(command, file, argv, words):
    before = file.read_bytes()
    code, out, err = command("preset", *argv, "--file", file)
    assert (code, out) == (2, "")
    assert words in err
    assert file.read_bytes() == before


def test_a_file_without_materials(command, registered, tmp_path):
    path = tmp_path / "empty.blend"
    registered.ops.wm.save_as_mainfile(filepath=str(path))
    assert "the file has no materials" in command("preset", "gold", "--material", "A")[2]
    assert command("convert", "--to", "native")[0] == 0
    assert command("update")[0] == 0


def test_names_that_several_have(registered):
    from addon.command.names import named_item
    from addon.command.output import CommandError

    gold = next(item for item in presets() if item.identifier == "conductor/gold")
    with pytest.raises(CommandError, match="Several presets are named 'gold'"):
        named_item("gold", (gold, gold), "preset")


def test_converting_there_and_back(command, file, registered):
    code, out, _ = command("convert", "--to", "microbounce", "--dry-run", "--file", file, "--json")
    assert code == 1, "there is something to convert"
    result = json.loads(out)
    assert (result["converted"], result["refused"], result["saved"]) == (1, 0, "")
    assert [m["material"] for m in result["materials"]] == ["Native", "Ours"]
    assert node_kinds(registered, file, "Native") == ["BSDF_METALLIC"]
    code, out, _ = command("convert", "--to", "microbounce", "--file", file, "--save")
    assert code == 0
    assert "Nodes converted: 1; that stay: 0" in out
    assert node_kinds(registered, file, "Native") == ["CONDUCTOR"]
    argv = ("convert", "--to", "native", "--material", "Native", "--file", file, "--save")
    assert command(*argv)[0] == 0
    assert node_kinds(registered, file, "Native") == ["BSDF_METALLIC"]
    assert node_kinds(registered, file, "Ours") == ["DIFFUSE"]


def test_grease_pencil_materials_are_left_out_unless_named(command, file, registered):
    pencil = registered.data.materials.new("Pencil")
    registered.data.materials.create_gpencil_data(pencil)
    pencil.use_fake_user = True
    registered.ops.wm.save_mainfile()
    code, out, _ = command("convert", "--to", "microbounce", "--file", file)
    assert (code, "Pencil" in out) == (0, False)
    arguments = ("convert", "--to", "microbounce", "--material", "Pencil", "--file", file)
    code, out, _ = command(*arguments)
    assert code == 1
    assert "'Pencil' is a grease pencil material" in out


def test_a_dry_run_that_shall_save_is_refused(command, file):
    code, _, err = command("update", "--dry-run", "--save", "--file", file)
    assert code == 2
    assert "A dry run saves nothing" in err


def test_updating(command, file, registered):
    code, out, _ = command("update", "--dry-run", "--file", file)
    assert (code, out) == (0, "All Microbounce materials are of this version\n")
    registered.data.node_groups["Microbounce Diffuse"]["microbounce_stamp"] = "old"
    registered.ops.wm.save_mainfile()
    assert command("update", "--dry-run", "--file", file)[0] == 1
    assert command("update", "--file", file, "--save", "--json")[0] == 0
    code, out, _ = command("update", "--dry-run", "--file", file, "--json")
    assert code == 0
    assert json.loads(out)["old"] == []
    assert command("check", "--file", file)[0] == 0
