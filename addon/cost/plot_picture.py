# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plot as a picture, its letters with the font that Blender ships."""

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy  # isort: split

# These two exist once bpy is imported.
import blf
import imbuf

from ..core.cost.plot import HEIGHT, WIDTH, Dot, Label, Line, draw_plot
from ..core.cost.png import rgb_png
from ..core.cost.results import Report

_SCALE = 2
_BACKGROUND = (0.11, 0.115, 0.13)
_NAMED = {"ink": (0.9, 0.91, 0.93), "grid": (0.22, 0.235, 0.26)}
_TEXT_SIZE = 12
_DASH = 12.0


def plot_png(report: Report) -> bytes:
    """Return the plot of a report as PNG. Raises RuntimeError where Blender's font is missing."""
    import numpy as np

    canvas = np.empty((HEIGHT * _SCALE, WIDTH * _SCALE, 3))
    canvas[:] = _BACKGROUND
    steps = draw_plot(report)
    for step in steps:
        if isinstance(step, Line):
            for start, end in _pieces(step):
                _draw_capsule(canvas, start, end, 0.5 * step.width, _rgb(step.color))
        elif isinstance(step, Dot):
            center = (step.x, step.y)
            _draw_capsule(canvas, center, center, step.radius, _rgb(step.color))
    return _with_labels(rgb_png(canvas), [step for step in steps if isinstance(step, Label)])


def _pieces(line: Line) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return the straight pieces of a line, or its dashes: it is straight then."""
    if not line.dashed:
        return list(zip(line.points, line.points[1:], strict=False))
    (x0, y0), (x1, y1) = line.points[0], line.points[-1]
    count = max(1, int(math.hypot(x1 - x0, y1 - y0) / _DASH))
    dashes = []
    for number in range(count):
        ends = (number / count, (number + 0.5) / count)
        dashes.append(tuple((x0 + t * (x1 - x0), y0 + t * (y1 - y0)) for t in ends))
    return dashes


def _draw_capsule(
    canvas: "numpy.ndarray",
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
    color: tuple[float, float, float],
) -> None:
    """Blend all that is within `radius` of a straight piece, with soft edges."""
    import numpy as np

    (x0, y0), (x1, y1) = ((x * _SCALE, y * _SCALE) for x, y in (start, end))
    radius *= _SCALE
    reach = radius + 1.0
    left, right = int(min(x0, x1) - reach), int(max(x0, x1) + reach) + 1
    top, bottom = int(min(y0, y1) - reach), int(max(y0, y1) + reach) + 1
    left, top = max(left, 0), max(top, 0)
    part = canvas[top:bottom, left:right]
    y, x = np.mgrid[top : top + part.shape[0], left : left + part.shape[1]] + 0.5
    length_square = (x1 - x0) ** 2 + (y1 - y0) ** 2
    along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / max(length_square, 1e-9)
    along = np.clip(along, 0.0, 1.0)
    distance = np.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0))
    cover = np.clip(radius + 0.5 - distance, 0.0, 1.0)[..., None]
    part[:] = (1.0 - cover) * part + cover * np.array(color)


def _with_labels(png: bytes, labels: list[Label]) -> bytes:
    font = blf.load(str(Path(bpy.utils.system_resource("DATAFILES"), "fonts", "Inter.woff2")))
    if font < 0:
        raise RuntimeError("Blender's own font Inter.woff2 is missing from its data files")
    with TemporaryDirectory() as folder:
        path = Path(folder, "plot.png")
        path.write_bytes(png)
        buffer = imbuf.load(str(path))
        with blf.bind_imbuf(font, buffer):
            blf.size(font, _TEXT_SIZE * _SCALE)
            for label in labels:
                width = blf.dimensions(font, label.text)[0]
                shift = {"start": 0.0, "middle": 0.5, "end": 1.0}[label.anchor] * width
                blf.color(font, *_rgb(label.color), 1.0)
                blf.position(font, label.x * _SCALE - shift, (HEIGHT - label.y) * _SCALE, 0)
                blf.draw_buffer(font, label.text)
        imbuf.write(buffer, filepath=str(path))
        return path.read_bytes()


def _rgb(color: str) -> tuple[float, float, float]:
    if color in _NAMED:
        return _NAMED[color]
    return tuple(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
