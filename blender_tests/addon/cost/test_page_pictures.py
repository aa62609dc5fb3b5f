# SPDX-License-Identifier: GPL-3.0-or-later
"""The page's pictures look as the scene's own renders do."""

import bpy
import numpy as np
import pytest

from addon.cost.page_pictures import ENLARGED, PagePictures, read_picture
from blender_tests.addon.support import small_scene

LAST_BIT = 1.01 / 255


def _render(scene, path, kind):
    """Return a render as Blender saves it."""
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode = kind, "RGB"
    settings.color_depth = "8" if kind == "PNG" else "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return read_picture(path)


def _drawn(scene, folder, reference, render, mean, width=640):
    """Return the pixels of the page's picture and of its difference."""
    _, pictures = PagePictures(scene, folder, reference, {"walk": (render, mean)}).drawn(width)
    found = []
    for png in (pictures["walk"].picture, pictures["walk"].difference):
        (folder / "page.png").write_bytes(png)
        found.append(read_picture(folder / "page.png"))
    return found


@pytest.mark.parametrize(("transform", "other"), [("Standard", "AgX"), ("AgX", "Standard")])
def test_a_picture_has_the_scenes_view_transform(empty_file, tmp_path, transform, other):
    scene, _ = small_scene(osl=False)
    scene.view_settings.view_transform = transform
    scene.view_settings.exposure = 1.0
    scene.render.dither_intensity = 0.0
    saved = _render(scene, tmp_path / "own.png", "PNG")
    linear = _render(scene, tmp_path / "own.exr", "OPEN_EXR")
    assert linear.max() > 0.1
    shown, _ = _drawn(scene, tmp_path, linear, linear, linear)
    assert np.abs(shown - saved).max() <= LAST_BIT
    scene.view_settings.view_transform = other
    assert np.abs(_drawn(scene, tmp_path, linear, linear, linear)[0] - saved).max() > 0.05


def test_a_difference_is_red_where_brighter(empty_file, tmp_path):
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    reference = np.full((6, 8, 3), 0.2, np.float32)
    mean = reference.copy()
    mean[:3, :4] *= 1.1
    mean[:3, 4:] *= 0.9
    before = len(bpy.data.images)
    _, shown = _drawn(scene, tmp_path, reference, reference, mean)
    assert len(bpy.data.images) == before
    brighter, darker, same = shown[1, 1], shown[1, 6], shown[4, 3]
    step = 1.055 * (0.22 ** (1 / 2.4) - 0.2 ** (1 / 2.4))
    assert brighter[0] == pytest.approx(0.5 + 0.5 * ENLARGED * step, abs=3 * LAST_BIT)
    assert brighter[0] > 0.5 > brighter[2]
    assert darker[2] > 0.5 > darker[0]
    assert same == pytest.approx(0.5, abs=LAST_BIT)


def test_a_picture_is_shrunk_to_the_width(empty_file, tmp_path):
    picture = np.random.default_rng(4).random((30, 60, 3), np.float32)
    shown, difference = _drawn(bpy.context.scene, tmp_path, picture, picture, picture, width=20)
    assert shown.shape == difference.shape == (10, 20, 3)
    assert np.abs(shown - shown.mean()).max() < 0.35, "each pixel is a mean of those within it"
