# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest and largest values of an image's channels, as a shader reads them."""

import bpy

from ..core.intervals import Interval

# Larger images are not read: their pixels would take more than 268 MB.
_MOST_PIXELS = 1 << 24
_RAW = ("Non-Color", "Raw", "Generic Data", "Linear", "Linear Rec.709", "scene_linear")


# Of red, green, blue and alpha.
ImageRange = tuple[Interval, ...]


class UnreadableImageError(Exception):
    """An image has no known ranges. The message is a clause that names it and says why."""


def image_range(image: bpy.types.Image) -> ImageRange:
    """Return the ranges of red, green, blue and alpha. It keeps no image in memory that was not
    there.

    Raises UnreadableImageError if it is missing, too large, a sequence, a movie or tiled, or in
    a colour space that is neither sRGB nor linear.
    """
    if image.source not in ("FILE", "GENERATED"):
        raise UnreadableImageError(f"the image '{image.name}' is {image.source.lower()}")
    loaded = image.has_data
    try:
        return _read(image)
    finally:
        if not loaded:
            image.buffers_free()


def _read(image: bpy.types.Image) -> ImageRange:
    import numpy as np

    name = f"the image '{image.name}'"
    width, height = image.size
    channels, encoded = image.channels, not image.is_float
    if not width * height:
        raise UnreadableImageError(f"the file of {name} is missing or cannot be read")
    if width * height > _MOST_PIXELS:
        raise UnreadableImageError(f"{name} is too large to be read ({width} x {height})")
    if channels not in (1, 3, 4):
        raise UnreadableImageError(f"{name} has {channels} channels")
    space = image.colorspace_settings.name
    if space not in (*_RAW, "sRGB"):
        raise UnreadableImageError(f"{name} is in the colour space {space}")
    pixels = np.empty(width * height * channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(-1, channels)
    # These ignore NaN.
    ends = np.stack([np.fmin.reduce(pixels), np.fmax.reduce(pixels)]).astype(float)
    colours = ends[:, :1].repeat(3, axis=1) if channels == 1 else ends[:, :3]
    # Byte images have the pixels of the file, float images linear ones.
    if space == "sRGB" and encoded:
        curve = ((np.maximum(colours, 0.0) + 0.055) / 1.055) ** 2.4
        colours = np.where(colours <= 0.04045, colours / 12.92, curve)
    alpha = ends[:, 3:] if channels == 4 else np.ones((2, 1))
    return tuple((float(low), float(high)) for low, high in np.hstack([colours, alpha]).T)
