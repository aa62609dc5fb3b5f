# SPDX-License-Identifier: GPL-3.0-or-later
"""The view of an analytic unit sphere, shared with scenes/sphere_sun_* and scenes/furnace_*.

The unit sphere at the origin; an orthographic camera at (0, -5, 0) that looks along +Y, up = +Z,
2.1 units wide. So the direction to the viewer is (0, -1, 0) everywhere, picture right is +X and
picture up is +Z. One sun shines on the side that the camera sees, another one through the surface
from behind.
"""

import numpy as np

from .vectors import normalize, vector
from .view import RESOLUTION, SUBSAMPLES, Axes, View, pixel_grid

CAMERA_WIDTH = 2.1
MASK_RADIUS = 0.985  # pixels farther out see too steep a part of the sphere
VIEW_DIRECTION = np.array([0.0, -1.0, 0.0])  # towards the viewer
FRONT_SUN = normalize(np.array([0.6, -0.72, 0.35]))  # towards the light
BACK_SUN = normalize(np.array([0.45, 0.85, 0.25]))


def view(
    resolution: int = RESOLUTION, subsamples: int = SUBSAMPLES, inside_out: bool = False
) -> View:
    """The sphere as the camera sees it.

    ``inside_out``: its normals point to its centre, so the camera is inside the solid and ``wi`` is
    below the surface.
    """
    points, mask = sphere_points(resolution, subsamples)
    axes = local_frames(-points if inside_out else points)
    return View(axes, np.broadcast_to(VIEW_DIRECTION, points.shape), mask)


def sphere_points(
    resolution: int = RESOLUTION, subsamples: int = SUBSAMPLES
) -> tuple[np.ndarray, np.ndarray]:
    """Points of the sphere behind each pixel's midpoint grid, and the mask of usable pixels.

    Returns points ``(resolution, resolution, subsamples^2, 3)``, which are their own normals, and
    booleans ``(resolution, resolution)``: pixels whose corners lie within `MASK_RADIUS`. Points of
    other pixels are set to the one that faces the camera.
    """
    x, z = pixel_grid(resolution, subsamples, CAMERA_WIDTH)
    edge = (np.abs(np.arange(resolution) + 0.5 - resolution / 2) + 0.5) / resolution * CAMERA_WIDTH
    mask = np.hypot(edge[:, None], edge[None, :]) <= MASK_RADIUS
    x, z = np.where(mask[..., None, None], x, 0.0), np.where(mask[..., None, None], z, 0.0)
    points = vector(x, -np.sqrt(1.0 - x * x - z * z), z)
    return points.reshape(resolution, resolution, subsamples * subsamples, 3), mask


def local_frames(normal: np.ndarray) -> Axes:
    """Axes x, y, z ``(..., 3)`` of the shading frame where the sphere's normal is ``normal``.

    As in Cycles without a linked tangent: the tangent runs around the object's Z axis, (-y, x, 0)
    from generated coordinates, made perpendicular to the normal; y = cross(z, x). It is undefined
    at the poles, which the mask keeps out of the picture.
    """
    normal = np.asarray(normal, dtype=np.float64)
    around = vector(-normal[..., 1], normal[..., 0], np.zeros(normal.shape[:-1]))
    y = normalize(np.cross(normal, around))
    return np.cross(y, normal), y, normal
