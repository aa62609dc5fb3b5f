# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture's pixels see: points of a surface, their shading frames, and the viewer.

Pictures are arrays ``(rows, columns, ...)``, top row first. A pixel is the mean over a square grid
of midpoints (box filter, one pixel wide).
"""

from dataclasses import dataclass, replace

import numpy as np

from .vectors import dot, vector

RESOLUTION = 64  # pixels on a side
SUBSAMPLES = 8  # midpoints per pixel side

Axes = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class View:
    """The points ``(rows, columns, points)`` behind a picture's pixels.

    ``axes``: x, y and z of the shading frame at each point, and ``viewer``: the direction from it
    to the viewer, each ``(rows, columns, points, 3)``. ``mask`` ``(rows, columns)``: the pixels to
    use.
    """

    axes: Axes
    viewer: np.ndarray
    mask: np.ndarray

    def row(self, row: int) -> tuple[np.ndarray, Axes]:
        """``wi`` and the axes, each ``(pixels, points, 3)``, of the usable pixels of a row."""
        here = row, self.mask[row]
        axes = tuple(axis[here] for axis in self.axes)
        return to_local(self.viewer[here], axes), axes

    def lit_from_above(self, sun: np.ndarray) -> "View":
        """The view of only those pixels whose points all face the ``sun`` ``(3,)``."""
        facing = (dot(self.axes[2], sun) > 0.0).all(axis=-1)
        return replace(self, mask=self.mask & facing)


def pixel_grid(resolution: int, subsamples: int, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of each pixel's midpoints in a square picture of this ``width``, centred on 0.

    To the right ``(1, columns, 1, s)`` and up ``(rows, 1, s, 1)``, which broadcast.
    """
    count = resolution * subsamples
    line = ((np.arange(count) + 0.5) / count - 0.5) * width
    line = line.reshape(resolution, subsamples)
    return line[None, :, None, :], -line[:, None, :, None]


def to_local(w: np.ndarray, axes: Axes) -> np.ndarray:
    """Components ``(..., 3)`` of the world direction ``w`` ``(3,)`` or ``(..., 3)`` along axes."""
    return vector(*(dot(axis, w) for axis in axes))
