# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of one rough side of a slab, shared with scenes/slab_dielectric.blend.

The plane z = 0, its normal +Z, under a sun that shines up through it. A perspective camera looks
down on it; its picture spans 50 degrees, and the plane fills it. Only the direction
to the viewer changes from pixel to pixel; frame and sun stay.
"""

import numpy as np

from .vectors import normalize, vector
from .view import RESOLUTION, SUBSAMPLES, View, pixel_grid

CAMERA_DIRECTION = normalize(np.array([0.0, 3.0, -2.0]))  # away from the viewer
CAMERA_ANGLE = np.radians(50.0)  # of the whole picture
SUN = normalize(np.array([0.1, 0.55, -0.83]))  # towards the light


def view(resolution: int = RESOLUTION, subsamples: int = SUBSAMPLES) -> View:
    """The slab as the camera sees it; every pixel is used."""
    right = np.array([1.0, 0.0, 0.0])
    up = np.cross(right, CAMERA_DIRECTION)
    x, y = pixel_grid(resolution, subsamples, 2.0 * np.tan(0.5 * CAMERA_ANGLE))
    ray = vector(*(CAMERA_DIRECTION[i] + right[i] * x + up[i] * y for i in range(3)))
    viewer = -normalize(ray).reshape(resolution, resolution, subsamples * subsamples, 3)
    axes = tuple(np.broadcast_to(axis, viewer.shape) for axis in np.eye(3))
    return View(axes, viewer, np.ones((resolution, resolution), dtype=bool))
