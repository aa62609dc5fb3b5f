# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts pictures out of Xvfb's screen."""

import struct
from pathlib import Path

import bpy
import numpy as np


def save_part(screen: Path, part: list[int], target: Path, quality: int = 75) -> None:
    """Save a part of a screen, as PNG if `target` ends in .png, else as JPEG.

    screen  -- Xvfb's file: an X window dump with the bytes blue, green, red, unused per pixel
    part    -- left, bottom, width and height in pixels, from the screen's bottom left
    quality -- of a JPEG, 0 to 100
    """
    left, bottom, width, height = part
    rows = _pixels(screen)[::-1][bottom : bottom + height, left : left + width]
    image = bpy.data.images.new("Screen", width, height)
    colors = np.ones((height, width, 4), np.float32)
    colors[..., :3] = rows[..., 2::-1] / 255.0
    image.pixels.foreach_set(colors.ravel())
    image.file_format = "PNG" if target.suffix == ".png" else "JPEG"
    image.save(filepath=str(target), quality=quality)
    bpy.data.images.remove(image)


def _pixels(screen: Path) -> np.ndarray:
    """Return the (height, width, 4) bytes of an X window dump, from its top row on.

    Raises ValueError unless it is a dump of 24 bits a pixel, as Xvfb writes.
    """
    data = screen.read_bytes()
    header = struct.unpack(">25I", data[:100])
    size, version, form, depth, width, height = header[:6]
    bits, row, colors = header[11], header[12], header[19]
    if (version, form, depth, bits) != (7, 2, 24, 32):
        raise ValueError(f"{screen} is no dump of 24 bits a pixel: {header[:12]}")
    start = size + 12 * colors  # a list of colours comes before the pixels
    pixels = np.frombuffer(data, np.uint8, row * height, start)
    return pixels.reshape(height, row // 4, 4)[:, :width]
