# SPDX-License-Identifier: GPL-3.0-or-later
"""The opening of a Blender's window, as far as tests without a window can tell."""

import struct
import subprocess
import sys

import bpy
import numpy as np
import pytest

from tools.window import blender
from tools.window.screen import save_part
from tools.window.session import ROOT


@pytest.fixture
def commands(tmp_path, monkeypatch):
    """A function that adds a command to PATH, which is empty otherwise."""
    monkeypatch.setenv("PATH", str(tmp_path))
    for name in ("BLENDER", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)

    def add(name, text="exit 0"):
        path = tmp_path / name
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
        return str(path)

    return add


def test_blender_is_found_on_the_path_or_named(commands, monkeypatch):
    with pytest.raises(blender.NoWindowError, match="set BLENDER"):
        blender.find_blender()
    path = commands("blender")
    assert blender.find_blender() == [path]
    other = commands("other")
    monkeypatch.setenv("BLENDER", "other --gpu-backend opengl")
    assert blender.find_blender() == [other, "--gpu-backend", "opengl"]
    monkeypatch.setenv("BLENDER", "missing run")
    with pytest.raises(blender.NoWindowError, match="names missing"):
        blender.find_blender()


def test_a_display_is_needed(commands, monkeypatch):
    with pytest.raises(blender.NoWindowError, match="install Xvfb"):
        blender.need_display()
    monkeypatch.setenv("DISPLAY", ":7")
    blender.need_display()
    monkeypatch.delenv("DISPLAY")
    commands("Xvfb")
    blender.need_display()


def test_without_blender_the_reason_is_printed(monkeypatch):
    monkeypatch.setenv("BLENDER", "/nowhere/blender")
    for task in ("test", "pictures"):
        command = [sys.executable, "-m", "tools.window", task]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        assert done.stdout.startswith("skipped: BLENDER names /nowhere/blender")


def test_the_result_is_read_and_a_missing_one_told(commands, monkeypatch, tmp_path):
    monkeypatch.setenv("DISPLAY", ":7")
    monkeypatch.setenv(
        "BLENDER", commands("blender", 'for last; do :; done; echo \'{"a": 1}\' >"$last"')
    )
    script = tmp_path / "script.py"
    result = blender.run_in_window(script, {}, 30.0)
    assert result == {"a": 1, "printed": ""}
    commands("blender", "echo went wrong; exit 4")
    with pytest.raises(RuntimeError, match=r"(?s)exit code 4.*went wrong"):
        blender.run_in_window(script, {}, 30.0)


def test_what_hangs_is_ended(commands, monkeypatch, tmp_path):
    monkeypatch.setenv("DISPLAY", ":7")
    monkeypatch.setenv("BLENDER", commands("blender", "echo begun; while :; do :; done"))
    with pytest.raises(TimeoutError, match=r"(?s)after 1 s.*begun"):
        blender.run_in_window(tmp_path / "script.py", {}, 1.0)


def dump(path, pixels, depth=24):
    """Write (height, width, 3) bytes, red first, as a screen of Xvfb."""
    height, width, _ = pixels.shape
    header = [100, 7, 2, depth, width, height, *[0] * 5, 32, 4 * width, *[0] * 6, 0, *[0] * 5]
    rows = np.zeros((height, width, 4), np.uint8)
    rows[..., :3] = pixels[..., ::-1]
    path.write_bytes(struct.pack(">25I", *header) + rows.tobytes())


def test_a_part_of_the_screen_is_saved(tmp_path):
    pixels = np.arange(5 * 6 * 3, dtype=np.uint8).reshape(5, 6, 3)
    dump(tmp_path / "screen.xwd", pixels)
    save_part(tmp_path / "screen.xwd", [1, 0, 4, 3], tmp_path / "part.png")
    image = bpy.data.images.load(str(tmp_path / "part.png"))
    saved = np.array(image.pixels).reshape(3, 4, 4)[::-1, :, :3]
    assert np.array_equal(np.rint(255 * saved), pixels[2:5, 1:5])
    bpy.data.images.remove(image)
    save_part(tmp_path / "screen.xwd", [0, 0, 6, 5], tmp_path / "part.jpg")
    assert (tmp_path / "part.jpg").read_bytes()[:2] == b"\xff\xd8"


def test_another_form_of_screen_is_refused(tmp_path):
    dump(tmp_path / "screen.xwd", np.zeros((2, 2, 3), np.uint8), depth=16)
    with pytest.raises(ValueError, match="no dump of 24 bits"):
        save_part(tmp_path / "screen.xwd", [0, 0, 2, 2], tmp_path / "part.png")
