# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of a page as PNG. Blender saves them, so they look as the scene's renders do."""

from dataclasses import dataclass
from pathlib import Path

import bpy

from ..core.cost.page import ENLARGED, Pictures


@dataclass(frozen=True)
class PagePictures:
    """Linear radiance (height, width, 3) of what a page shows.

    scene     -- its view transform applies, and its image settings are changed
    folder    -- for temporary files
    reference -- the mean of the reference's pictures
    renders   -- by the variants' keys: one render, and the mean of all renders
    """

    scene: bpy.types.Scene
    folder: Path
    reference: "numpy.ndarray"
    renders: "dict[str, tuple[numpy.ndarray, numpy.ndarray]]"

    def drawn(self, width: int) -> tuple[bytes, dict[str, Pictures]]:
        """Return PNGs at most `width` wide: the reference, and the pictures of each variant."""
        settings = self.scene.render.image_settings
        settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "8"
        reference = self._shown(self.reference, width)
        pictures = {}
        for key, (render, mean) in self.renders.items():
            difference = self._difference(self._shown(mean, width), reference)
            pictures[key] = Pictures(self._shown(render, width), difference)
        return reference, pictures

    def _shown(self, linear: "numpy.ndarray", width: int) -> bytes:
        """Return a picture through the view transform."""
        image = _new_image(linear, float_buffer=True)
        try:
            if image.size[0] > width:
                image.scale(width, max(1, round(image.size[1] * width / image.size[0])))
            path = self.folder / "shown.png"
            image.save_render(str(path), scene=self.scene)
            return path.read_bytes()
        finally:
            bpy.data.images.remove(image)

    def _difference(self, png: bytes, reference: bytes) -> bytes:
        """Return the enlarged difference: blue is darker, red is brighter, grey is the same."""
        import numpy as np

        both = self._display_values(png) - self._display_values(reference)
        difference = np.clip(ENLARGED * both.mean(axis=2), -1.0, 1.0)
        channels = (1.0 + difference, 1.0 - np.abs(difference), 1.0 - difference)
        image = _new_image(0.5 * np.stack(channels, axis=-1), float_buffer=False)
        try:
            path = self.folder / "difference.png"
            image.filepath_raw, image.file_format = str(path), "PNG"
            image.save()
            return path.read_bytes()
        finally:
            bpy.data.images.remove(image)

    def _display_values(self, png: bytes) -> "numpy.ndarray":
        """Return the values of a PNG from 0 to 1, (height, width, 3)."""
        path = self.folder / "read.png"
        path.write_bytes(png)
        return read_picture(path)


def read_picture(path: Path) -> "numpy.ndarray":
    """Return the stored values of a picture file, (height, width, 3), top row first."""
    import numpy as np

    image = bpy.data.images.load(str(path))
    try:
        width, height = image.size
        values = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(values)
    finally:
        bpy.data.images.remove(image)
    # Blender's first row is the lowest.
    return values.reshape(height, width, 4)[::-1, :, :3].copy()


def _new_image(pixels: "numpy.ndarray", float_buffer: bool) -> bpy.types.Image:
    import numpy as np

    height, width = pixels.shape[:2]
    image = bpy.data.images.new("Page", width, height, float_buffer=float_buffer)
    values = np.ones((height, width, 4), np.float32)
    values[..., :3] = pixels[::-1]
    image.pixels.foreach_set(values.ravel())
    return image
