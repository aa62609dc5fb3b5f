# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: exit codes, help, JSON alone on standard output, errors with remedies."""

import json

import pytest

from blender_tests.addon.support import small_scene


@pytest.fixture
def command(registered, capfd):
    """Runs the command; returns its exit code, standard output and standard error."""
    from addon.command.main import main

    def run(*argv):
        capfd.readouterr()
        code = main([str(word) for word in argv])
        return code, *capfd.readouterr()

    return run


@pytest.fixture
def clean(registered, tmp_path):
    """A file with one of our materials and nothing to find."""
    from addon.nodes.group import new_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material("DIFFUSE", "Ours"))
    path = tmp_path / "clean.blend"
    registered.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_check_of_a_clean_file(command, clean, empty_file):
    code, out, _ = command("check", "--file", clean, "--json")
    assert code == 0
    assert json.loads(out) == {"command": "check", "file": str(clean), "ok": True, "findings": []}
    code, out, _ = command("check", "--file", clean)
    assert (code, out) == (0, f"{clean}: nothing found\n")
