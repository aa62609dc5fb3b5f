# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's picture with titles and captions."""

import numpy as np
import OpenImageIO as oiio

from scenes import comparison


def compared(title):
    pictures = [np.full((60, 220, 3), value, np.float32) for value in (0.25, 0.75)]
    return comparison.side_by_side(pictures, [title, title], [["a"], ["b", "c"]], "footer")


def test_pictures_stand_side_by_side_unchanged():
    result = compared("")
    top = comparison.MARGIN
    for column, value in enumerate((0.25, 0.75)):
        left = top + column * (220 + comparison.MARGIN)
        np.testing.assert_array_equal(result[top : top + 60, left : left + 220], value)
    assert np.abs(result[:top] - np.float32(comparison.BACKGROUND)).max() == 0.0


def test_letters_are_drawn_below_the_pictures():
    difference = np.abs(compared("Title") - compared("")).max(axis=-1)
    assert (difference > 0.5).sum() > 100  # strokes of the two titles
    assert difference[: comparison.MARGIN + 60].max() == 0.0


def test_files_hold_the_picture(tmp_path):
    result = compared("Title")
    comparison.write_png(tmp_path / "a.png", result)
    comparison.write_jpeg(tmp_path / "made" / "a.jpg", result)
    png = oiio.ImageBuf(str(tmp_path / "a.png")).get_pixels(oiio.FLOAT)
    np.testing.assert_allclose(png, result, atol=0.51 / 255)  # rounded to 8 bits
    jpeg = oiio.ImageBuf(str(tmp_path / "made" / "a.jpg")).get_pixels(oiio.FLOAT)
    assert jpeg.shape == result.shape
    assert np.abs(jpeg - result).mean() < 0.02  # quality 88 loses less on flat tones
