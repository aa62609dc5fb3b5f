# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets' pictures are complete, current, small and well exposed; the command works."""

import dataclasses
import json
import shutil

import bpy
import numpy as np
import pytest

from addon.core.presets import catalogue as presets
from addon.presets import icons as preset_icons
from tools.previews import __main__ as command
from tools.previews import scene as preview_scene


def picture(path):
    """The 8-bit values of a picture over 255, (height, width, 3)."""
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[..., :3]


def test_the_committed_pictures_are_complete_and_small(capsys):
    assert command.main(["--check"]) == 0, capsys.readouterr().err
    for preset in presets.presets():
        pixels = picture(preset_icons.picture_path(preset.identifier))
        assert pixels.shape == (preview_scene.SIZE, preview_scene.SIZE, 3)
        assert 0.15 < pixels.mean() < 0.85, f"{preset.identifier} is too dark or too bright"
        assert (pixels.min(axis=-1) > 0.995).mean() < 0.05, f"{preset.identifier} is burnt"


def test_metals_differ_in_their_pictures_as_in_their_values():
    size = preview_scene.SIZE
    middle = slice(size // 3, 2 * size // 3)
    colors = {}
    for name in ("gold", "silver", "copper"):
        path = preset_icons.picture_path(f"conductor/{name}")
        colors[name] = picture(path)[middle, middle].mean(axis=(0, 1))
    for name in ("gold", "copper"):
        assert colors[name][0] > colors[name][2] + 0.1, f"{name} is warm"
    assert np.ptp(colors["silver"]) < 0.1, "silver is gray"
    assert colors["silver"].mean() > colors["copper"].mean()


@pytest.fixture
def few(tmp_path, monkeypatch):
    """A folder with the pictures of two presets, which are all that the command sees."""
    chosen = [presets.preset("conductor/gold"), presets.preset("dielectric/water")]
    folder = tmp_path / "previews"
    folder.mkdir()
    known = command.known_fingerprints()
    for item in chosen:
        shutil.copy2(preset_icons.picture_path(item.identifier), folder)
    monkeypatch.setattr(preset_icons, "FOLDER", folder)
    monkeypatch.setattr(command, "presets", lambda: tuple(chosen))
    monkeypatch.setattr(command, "ROOT", tmp_path)
    kept = {item.identifier: known[item.identifier] for item in chosen}
    command.manifest_path().write_text(json.dumps({"pictures": kept}))
    assert command.complaints() == []
    return folder


def test_what_is_missing_old_or_left_over_is_named(few, monkeypatch, capsys):
    gold = few / "conductor-gold.webp"
    shutil.copy2(gold, few / "conductor-unheard-of.webp")
    gold.unlink()
    assert command.main(["--check"]) == 1
    message = capsys.readouterr().err
    assert "conductor/gold: no picture of today's values" in message
    assert "conductor-unheard-of.webp: belongs to no preset" in message
    assert "dielectric/water" not in message
    assert "make previews" in message
    assert not gold.exists(), "--check renders nothing"


def test_other_values_make_a_picture_old(few, monkeypatch):
    gold, water = command.presets()
    other = dataclasses.replace(gold, values={**gold.values, "BaseColor": (0.5, 0.5, 0.5)})
    monkeypatch.setattr(command, "presets", lambda: (other, water))
    assert command.outdated() == [other]


def test_another_scene_makes_every_picture_old(few, monkeypatch, tmp_path):
    script = tmp_path / "preview_scene.py"
    script.write_text("# another")
    monkeypatch.setattr(preview_scene, "__file__", str(script))
    assert command.outdated() == list(command.presets())


def test_too_many_bytes_are_named(few, monkeypatch):
    monkeypatch.setattr(command, "LIMIT", 1000)
    assert any("may take 1000" in complaint for complaint in command.complaints())


def test_one_picture_is_rendered_anew(few, monkeypatch):
    monkeypatch.setattr(preview_scene, "SIZE", 24)
    monkeypatch.setattr(preview_scene, "SAMPLES", 4)
    gold, water = few / "conductor-gold.webp", few / "dielectric-water.webp"
    before = water.read_bytes()
    gold.write_bytes(b"damaged")
    assert command.main(["--only", "conductor/gold"]) == 0
    pixels = picture(gold)
    assert pixels.shape == (24, 24, 3)
    center = pixels[8:16, 8:16].mean(axis=(0, 1))
    assert center[0] > center[2] + 0.1, "gold is yellow"
    assert water.read_bytes() == before
    content = gold.read_bytes()
    assert str(few).encode() not in content
    assert command.outdated() == []


def test_an_unknown_name_is_refused(few, capsys):
    with pytest.raises(SystemExit):
        command.main(["--only", "conductor/unheard-of"])
    assert "there is no preset 'conductor/unheard-of'" in capsys.readouterr().err
