# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference pictures of an analytic unit sphere, under a sun or in a uniform world.

Geometry, shared with scenes/sphere_sun_conductor.blend and scenes/furnace_conductor.blend: the unit
sphere at the origin; an orthographic camera at (0, -5, 0) that looks along +Y, up = +Z, 2.1 units
wide. So the direction to the viewer is (0, -1, 0) everywhere, picture right is +X and picture up is
+Z. The sun's irradiance on a plane that faces it is 1 (Blender: strength 1, angle 0), so a pixel's
radiance is the mean of BRDF times cosine over the pixel (box filter, one pixel wide). In the
uniform world of radiance 1 it is the mean directional albedo.

Pictures are arrays ``(rows, columns, 3)``, top row first.
"""

from collections.abc import Callable, Iterable

import numpy as np

from .estimate import energies, evaluate
from .surface import Surface
from .vectors import dot, normalize, vector

RESOLUTION = 64  # pixels on a side
CAMERA_WIDTH = 2.1
MASK_RADIUS = 0.985  # pixels that reach farther out see too steep a part of the sphere
SUBSAMPLES = 8  # midpoints per pixel side; the error of this rule is below 1e-4 at alpha 0.25
VIEW_DIRECTION = np.array([0.0, -1.0, 0.0])  # towards the viewer
SUN_DIRECTION = normalize(np.array([0.6, -0.72, 0.35]))  # towards the light
MAX_BOUNCES = 32  # of GGX at alpha 1, less than 1e-9 of the energy is left after these

Progress = Callable[[Iterable[int]], Iterable[int]]


def sphere_points(
    resolution: int = RESOLUTION, subsamples: int = SUBSAMPLES
) -> tuple[np.ndarray, np.ndarray]:
    """Points of the sphere behind each pixel's midpoint grid, and the mask of usable pixels.

    Returns points ``(resolution, resolution, subsamples^2, 3)``, which are their own normals, and
    booleans ``(resolution, resolution)``: pixels whose corners lie within `MASK_RADIUS`. Points of
    other pixels are set to the one that faces the camera.
    """
    count = resolution * subsamples
    line = ((np.arange(count) + 0.5) / count - 0.5) * CAMERA_WIDTH
    line = line.reshape(resolution, subsamples)
    x = line[None, :, None, :]
    z = -line[:, None, :, None]
    edge = (np.abs(np.arange(resolution) + 0.5 - resolution / 2) + 0.5) / resolution * CAMERA_WIDTH
    mask = np.hypot(edge[:, None], edge[None, :]) <= MASK_RADIUS
    x, z = np.where(mask[..., None, None], x, 0.0), np.where(mask[..., None, None], z, 0.0)
    points = vector(x, -np.sqrt(1.0 - x * x - z * z), z)
    return points.reshape(resolution, resolution, subsamples * subsamples, 3), mask


def local_frames(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axes x, y, z ``(..., 3)`` of the shading frame at ``points`` of the unit sphere.

    As in Cycles where no tangent is linked: the tangent runs around the object's Z axis, (-y, x, 0)
    from generated coordinates, made perpendicular to the normal; y = cross(z, x). At the poles it
    is not defined; the mask keeps them out of the picture.
    """
    normal = np.asarray(points, dtype=np.float64)
    around = vector(-normal[..., 1], normal[..., 0], np.zeros(normal.shape[:-1]))
    y = normalize(np.cross(normal, around))
    return np.cross(y, normal), y, normal


def to_local(w: np.ndarray, frames: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Components ``(..., 3)`` of the world direction ``w`` ``(3,)`` along the frames' axes."""
    return vector(*(dot(axis, w) for axis in frames))


def sun_picture(
    surface: Surface,
    walks: int,
    seed: int,
    resolution: int = RESOLUTION,
    progress: Progress = iter,
) -> dict[str, np.ndarray]:
    """Render the sphere under the sun with ``walks`` walks for each of a pixel's 64 points.

    Returns pictures ``mean``, ``error`` (standard error of the mean), ``single`` (first bounce
    alone, exact), and the ``mask`` ``(rows, columns)``; all 0 outside the mask. Pixels are
    independent. The values of walks are skewed, so a test over many pixels should divide the sum
    of differences by the root of summed squared errors, not average each pixel's own ratio.
    """

    def shade(frames: tuple[np.ndarray, ...], rng: np.random.Generator) -> tuple[np.ndarray, ...]:
        wi, wo = to_local(VIEW_DIRECTION, frames), to_local(SUN_DIRECTION, frames)
        lit = wo[..., 2] > 0.0
        mean, variance, single = (np.zeros((*lit.shape, 3)) for _ in range(3))
        if lit.any():
            found = evaluate(wi[lit], wo[lit], surface, MAX_BOUNCES, walks, rng)
            mean[lit], variance[lit] = found.total, found.total_variance
            single[lit] = found.mean[0]
        return mean, variance, single

    mean, variance, single, mask = _render(shade, seed, resolution, progress)
    return {"mean": mean, "error": np.sqrt(variance), "single": single, "mask": mask}


def furnace_picture(
    surface: Surface,
    walks: int,
    seed: int,
    resolution: int = RESOLUTION,
    progress: Progress = iter,
) -> dict[str, np.ndarray]:
    """Render the sphere in a uniform world of radiance 1; pictures ``mean``, ``error``, ``mask``,
    otherwise as `sun_picture`."""

    def shade(frames: tuple[np.ndarray, ...], rng: np.random.Generator) -> tuple[np.ndarray, ...]:
        wi = to_local(VIEW_DIRECTION, frames)
        found = energies(wi, surface, MAX_BOUNCES, walks, rng).both
        return found.total, found.total_variance, found.mean[0]

    mean, variance, _, mask = _render(shade, seed, resolution, progress)
    return {"mean": mean, "error": np.sqrt(variance), "mask": mask}


def _render(
    shade: Callable[..., tuple[np.ndarray, ...]], seed: int, resolution: int, progress: Progress
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Average a shader's mean, variance and single bounce over the points of each masked pixel."""
    points, mask = sphere_points(resolution)
    mean, variance, single = (np.zeros((resolution, resolution, 3)) for _ in range(3))
    for row in progress(range(resolution)):
        here = mask[row]
        if not here.any():
            continue
        rng = np.random.default_rng([seed, row])  # a row is the same whatever else is rendered
        values, variances, singles = shade(local_frames(points[row, here]), rng)
        mean[row, here] = values.mean(axis=1)
        variance[row, here] = variances.mean(axis=1) / variances.shape[1]
        single[row, here] = singles.mean(axis=1)
    return mean, variance, single, mask.astype(np.float64)
