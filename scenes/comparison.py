# SPDX-License-Identifier: GPL-3.0-or-later
"""Lays pictures side by side with a title and figures under each.

Blender draws the letters with its own font, so no display and no system font is needed.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import bpy  # isort: split

# These two exist once bpy is imported.
import blf
import imbuf
import numpy as np
import OpenImageIO as oiio

from .render import write_image

MARGIN = 20
TITLE_SIZE = 23
TEXT_SIZE = 16
LINE_HEIGHT = 24
BACKGROUND = (0.075, 0.075, 0.085)
TITLE_COLOR = (0.95, 0.95, 0.95)
TEXT_COLOR = (0.68, 0.68, 0.70)


def side_by_side(
    pictures: list[np.ndarray], titles: list[str], captions: list[list[str]], footer: str
) -> np.ndarray:
    """Return one picture, float32 (height, width, 3), display-referred like `pictures`.

    pictures -- all of one shape (height, width, 3)
    titles, captions -- one for each picture; a caption is a list of lines
    """
    height, width = pictures[0].shape[:2]
    lines = max(len(caption) for caption in captions)
    text_top = MARGIN + height + 12
    total_height = text_top + TITLE_SIZE + 14 + lines * LINE_HEIGHT + 10 + LINE_HEIGHT + MARGIN // 2
    total_width = MARGIN + len(pictures) * (width + MARGIN)
    canvas = np.empty((total_height, total_width, 3), np.float32)
    canvas[:] = BACKGROUND
    texts = []
    for column, picture in enumerate(pictures):
        left = MARGIN + column * (width + MARGIN)
        canvas[MARGIN : MARGIN + height, left : left + width] = picture
        baseline = text_top + TITLE_SIZE
        texts.append((left, baseline, TITLE_SIZE, TITLE_COLOR, titles[column]))
        for number, line in enumerate(captions[column]):
            below = baseline + 6 + (number + 1) * LINE_HEIGHT
            texts.append((left, below, TEXT_SIZE, TEXT_COLOR, line))
    texts.append((MARGIN, total_height - MARGIN // 2 - 4, TEXT_SIZE - 2, TEXT_COLOR, footer))
    return _with_texts(canvas, texts)


def write_png(path: Path, picture: np.ndarray) -> None:
    """Write a display-referred picture (height, width, 3) as 8-bit PNG."""
    spec = oiio.ImageSpec(picture.shape[1], picture.shape[0], 3, oiio.UINT8)
    write_image(path, picture, spec)


def write_jpeg(path: Path, picture: np.ndarray, quality: int = 88) -> None:
    """Write a display-referred picture (height, width, 3) as JPEG; make its folder if needed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    spec = oiio.ImageSpec(picture.shape[1], picture.shape[0], 3, oiio.UINT8)
    spec.attribute("Compression", f"jpeg:{quality}")
    write_image(path, picture, spec)


def _with_texts(canvas: np.ndarray, texts: list[tuple]) -> np.ndarray:
    """Return the canvas with texts, each (left, baseline from the top, size, colour, line)."""
    height, width = canvas.shape[:2]
    buffer = imbuf.new((width, height))
    font = blf.load(str(Path(bpy.utils.system_resource("DATAFILES"), "fonts", "Inter.woff2")))
    if font < 0:
        raise RuntimeError("Blender's own font Inter.woff2 is missing from its data files")
    with blf.bind_imbuf(font, buffer):
        for left, baseline, size, color, text in texts:
            blf.size(font, size)
            blf.color(font, *color, 1.0)
            blf.position(font, left, height - baseline, 0)
            blf.draw_buffer(font, text)
    with TemporaryDirectory() as folder:
        path = str(Path(folder, "text.png"))
        imbuf.write(buffer, filepath=path)
        drawn = oiio.ImageBuf(path).get_pixels(oiio.FLOAT)
    # OpenImageIO multiplies a PNG's colours by alpha when it reads them.
    return drawn[..., :3] + canvas * (1.0 - drawn[..., 3:4])
