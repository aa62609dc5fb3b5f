# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `cost`: its result, its exit codes, and references that it finds again."""

import json

import pytest

from addon.cost import reference_cache
from blender_tests.addon.cost.cost_support import tiny_scene

QUICK = (
    *("--samples", 2, "--percentage", 0, "--steps", "none", "--bounces", 1, "--no-cycles"),
    *("--rounds", 2, "--reference-samples", 4),
)


@pytest.fixture
def file(registered, compiled_once, monkeypatch, tmp_path):
    """A tiny scene on disk; the cache is in a folder of the test."""
    monkeypatch.setattr(reference_cache, "cache_folder", lambda: tmp_path / "cache")
    tiny_scene(tmp_path / "tiny.blend")
    return tmp_path / "tiny.blend"


def test_measured_twice_and_with_a_changed_scene(command, file, tmp_path, registered):
    content = file.read_bytes()
    code, out, err = command("cost", "--file", file, *QUICK, "--json")
    assert code == 0
    first = json.loads(out)
    assert (first["command"], first["file"]) == ("cost", str(file))
    assert [row["key"] for row in first["variants"]] == ["bounces_1"]
    assert first["setting"]["reference_kept"] is False
    assert "100 % Writing the report" in err
    assert file.read_bytes() == content
    assert len(list((tmp_path / "cache").iterdir())) == 1

    code, out, err = command("cost", "--file", file, *QUICK, "--output", tmp_path / "again")
    assert code == 0
    assert "Reference, 1 of 2" not in err
    assert "Walk, 1 bounce" in out
    assert f"Report: {tmp_path / 'again' / 'cost.html'}" in out
    again = json.loads((tmp_path / "again" / "cost.json").read_text("utf-8"))
    assert again["setting"]["reference_kept"] is True
    assert again["variants"][0]["noise"] == pytest.approx(first["variants"][0]["noise"])

    registered.data.lights[0].energy = 40.0
    registered.ops.wm.save_mainfile()
    code, out, err = command("cost", "--file", file, *QUICK, "--region", "0,0,0.5,1", "--json")
    changed = json.loads(out)["setting"]
    assert (changed["reference_kept"], changed["width"], changed["height"]) == (False, 12, 24)


def test_a_cache_that_cannot_be_written_is_told(command, file, tmp_path):
    (tmp_path / "cache").write_text("a file in its place", "utf-8")
    code, out, _ = command("cost", "--file", file, *QUICK, "--json")
    assert code == 0
    notes = json.loads(out)["setting"]["notes"]
    assert any(f"{tmp_path / 'cache'}" in note and "cannot be written" in note for note in notes)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--steps", "best"), "Step cannot be Best: give Single, Fitted, Walk, Exact"),
        (("--bounces", "1,x"), "'x' is no number"),
        (("--rounds", "1"), "Rounds cannot be 1"),
        (("--region", "0,0,1"), "four numbers"),
        (("--error", "0"), "Error cannot be 0.0"),
    ],
)
def test_wrong_use(command, file, arguments, message):
    code, out, err = command("cost", "--file", file, *arguments, "--json")
    assert code == 2
    assert message in json.loads(out)["error"]
    assert message in err


def test_what_cannot_be_measured(command, file, registered):
    registered.context.scene.camera = None
    registered.ops.wm.save_mainfile()
    code, out, err = command("cost", "--file", file, *QUICK)
    assert (code, out) == (2, "")
    assert f"{file}: The scene 'Scene' has no camera: add one" in err
