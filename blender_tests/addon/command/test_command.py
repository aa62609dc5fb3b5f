# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: exit codes, help, JSON alone on standard output, errors with remedies."""

import argparse
import json
import os

import pytest

from addon.core import VERSION
from blender_tests.addon.support import small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def clean(registered, tmp_path):
    """A file with one of our materials and nothing to find."""
    from addon.material.node import new_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material("DIFFUSE", "Ours"))
    path = tmp_path / "clean.blend"
    registered.ops.wm.save_as_mainfile(filepath=str(path))
    return path


@pytest.fixture
def faulty(clean, registered):
    """The same file without bytecode, and with OSL off."""
    registered.data.node_groups[0].nodes["Multiple Bounces"].bytecode = ""
    registered.context.scene.cycles.shading_system = False
    registered.ops.wm.save_mainfile()
    return clean


def test_check_of_a_clean_file(command, clean):
    code, out, _ = command("check", "--file", clean, "--json")
    assert code == 0
    assert json.loads(out) == {
        "command": "check",
        "file": str(clean),
        "ok": True,
        "findings": [],
        "proof": None,
    }
    code, out, _ = command("check", "--file", clean)
    assert (code, out) == (0, f"{clean}: nothing found\n")


def test_check_of_a_faulty_file(command, faulty):
    code, out, _ = command("check", "--file", faulty, "--json")
    assert code == 1
    result = json.loads(out)
    assert result["ok"] is False
    assert [finding["level"] for finding in result["findings"]] == ["error", "error"]
    assert all(set(f) == {"level", "subject", "message", "remedy"} for f in result["findings"])
    code, out, _ = command("check", "--file", faulty)
    assert code == 1
    assert "Error: Node group 'Microbounce Diffuse': Its bytecode was taken out" in out
    assert out.endswith(f"{faulty}: 2 errors found\n")


def test_the_file_that_is_open_is_checked_without_being_loaded(command, clean, registered):
    registered.context.scene.cycles.shading_system = False
    assert command("check")[0] == 1
    assert command("check", "--file", clean)[0] == 0, "--file reads what is saved"


def test_notes_alone_are_no_failure(command, registered, clean):
    registered.data.node_groups[0]["microbounce_stamp"] = "old"
    code, out, _ = command("check")
    assert code == 0
    assert "1 note found" in out


def test_check_with_proof(command, clean, faulty):
    code, out, err = command("check", "--prove", "--json")
    assert code == 1
    result = json.loads(out)
    assert set(result["proof"]) == {"ok", "difference", "brightness", "seconds"}
    assert "1 of 2" in err


def test_a_proof_that_fails_is_an_error(command, clean):
    code, out, err = command("check", "--prove", "--time-limit", "0.1", "--json")
    assert code == 2
    assert "took longer than 0.1 seconds" in json.loads(out)["error"]
    assert "took longer than 0.1 seconds" in err


def test_nothing_is_written(command, faulty):
    before = {path: path.read_bytes() for path in faulty.parent.iterdir()}
    command("check", "--file", faulty)
    assert {path: path.read_bytes() for path in faulty.parent.iterdir()} == before


def test_help_has_examples_and_exit_codes(command):
    from addon.command.main import SUBCOMMANDS

    code, out, _ = command("--help")
    assert code == 0
    assert "exit codes: 0" in out
    for module in SUBCOMMANDS:
        assert module.NAME in out
        code, text, _ = command(module.NAME, "--help")
        assert code == 0
        assert f"microbounce {module.NAME}" in text
        assert "examples:" in text
    assert command("--version")[:2] == (0, f"Microbounce {VERSION}\n")


@pytest.mark.parametrize(
    "argv",
    [
        [],
        ["chekc"],
        ["check", "--what"],
        ["check", "--time-limit", "-1"],
        ["check", "--time-limit", "x"],
    ],
)
def test_wrong_use(command, argv):
    code, out, err = command(*argv)
    assert code == 2
    assert out == ""
    assert "usage:" in err
    assert "_seconds" not in err, "no name of the code"


def test_files_that_cannot_be_opened(command, tmp_path):
    code, out, err = command("check", "--file", tmp_path / "gone.blend")
    assert (code, out) == (2, "")
    assert f"{tmp_path / 'gone.blend'} does not exist: check the path" in err
    assert "is a folder" in command("check", "--file", tmp_path)[2]
    assert f"{os.devnull} is no file" in command("check", "--file", os.devnull)[2]
    text = tmp_path / "text.blend"
    text.write_text("no scene", encoding="utf-8")
    code, out, _ = command("check", "--file", text, "--json")
    assert code == 2
    assert f"{text} cannot be opened" in json.loads(out)["error"]


def test_no_file_at_all(command, empty_file):
    code, _, err = command("check")
    assert code == 2
    assert "No file is open: name one with --file" in err


def test_what_blender_prints_does_not_reach_standard_output(command, clean, monkeypatch):
    from addon.command import check

    def noisy(scene):
        print("from Python")
        os.write(1, b"from compiled parts\n")
        return []

    monkeypatch.setattr(check, "farm_findings", noisy)
    code, out, err = command("check", "--file", clean, "--json")
    assert code == 0
    json.loads(out)
    assert "from Python" in err
    assert "from compiled parts" in err


def save_arguments(*argv):
    from addon.command.files import add_save_arguments

    parser = argparse.ArgumentParser()
    add_save_arguments(parser)
    return parser.parse_args([str(word) for word in argv])


def test_saving_only_where_asked(clean, registered, tmp_path):
    from addon.command.files import save_file
    from addon.command.output import CommandError

    before = clean.read_bytes()
    registered.data.texts.new("New")
    assert save_file(save_arguments()) == ""
    assert clean.read_bytes() == before
    copy = tmp_path / "copy.blend"
    assert save_file(save_arguments("--save-as", copy)) == str(copy)
    assert clean.read_bytes() == before
    with pytest.raises(CommandError, match=r"is there already: add --overwrite"):
        save_file(save_arguments("--save-as", copy))
    assert save_file(save_arguments("--save-as", copy, "--overwrite")) == str(copy)
    registered.ops.wm.open_mainfile(filepath=str(clean))
    registered.data.texts.new("New")
    assert save_file(save_arguments("--save")) == str(clean)
    assert clean.read_bytes() != before


@pytest.mark.parametrize(
    ("target", "words"),
    [("gone/new.blend", "does not exist: make it"), ("new.txt", "let it end in .blend")],
)
def test_targets_that_cannot_be_saved_to(clean, tmp_path, target, words):
    from addon.command.files import check_target
    from addon.command.output import CommandError

    with pytest.raises(CommandError, match=words):
        check_target(save_arguments("--save-as", tmp_path / target))


def test_a_target_that_cannot_be_written(clean, registered, tmp_path):
    from addon.command.files import save_file
    from addon.command.output import CommandError

    # A folder in the file's place refuses everyone; a read-only folder lets root write.
    (tmp_path / "new.blend").mkdir()
    with pytest.raises(
        CommandError, match=r"cannot be written: .*Make it writable, or save elsewhere"
    ):
        save_file(save_arguments("--save-as", tmp_path / "new.blend", "--overwrite"))


def test_a_bug_is_not_taken_for_a_finding(command, clean, monkeypatch):
    from addon.command import check

    monkeypatch.setattr(check, "farm_findings", lambda scene: 1 / 0)
    code, out, err = command("check", "--json")
    assert code == 2
    assert "ZeroDivisionError" in json.loads(out)["error"]
    assert "Traceback" in err


def test_a_compressed_file_stays_compressed(registered, clean):
    from addon.command.files import save_file

    registered.ops.wm.save_as_mainfile(filepath=str(clean), compress=True)
    magic = clean.read_bytes()[:4]
    assert magic != b"BLEN"
    assert save_file(save_arguments("--save")) == str(clean)
    assert clean.read_bytes()[:4] == magic


def test_a_newer_blenders_file_is_not_saved_in_its_place(registered, clean, tmp_path):
    from addon.command.files import save_file
    from addon.command.output import CommandError

    registered.ops.wm.save_as_mainfile(filepath=str(clean), compress=False)
    content = clean.read_bytes()
    version = "{}{:02}".format(*registered.app.version[:2]).encode()
    newer = content.replace(version, version[:-1] + b"9", 1)
    assert newer[:20] != content[:20], "the header has the version"
    clean.write_bytes(newer)
    registered.ops.wm.open_mainfile(filepath=str(clean))
    with pytest.raises(CommandError, match=r"would lose what is newer: use that version, or --sav"):
        save_file(save_arguments("--save"))
    assert clean.read_bytes() == newer
    copy = tmp_path / "older.blend"
    assert save_file(save_arguments("--save-as", copy)) == str(copy)
