# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference pictures of a view, under a sun or in a uniform world.

The sun's irradiance on a plane that faces it is 1 (Blender: strength 1, angle 0), so a pixel's
radiance is the mean of BSDF times cosine over the pixel. In the uniform world of radiance 1 it is
the mean directional albedo. Light through a dielectric counts as energy (basic radiance, as in
Cycles). The radiance inside would take another square of the index.
"""

from collections.abc import Callable, Iterable

import numpy as np

from .estimate import energies, evaluate
from .surface import Surface
from .view import Axes, View, to_local

MAX_BOUNCES = 32  # leave less than 1e-9 of the energy inside for GGX at alpha 1

Progress = Callable[[Iterable[int]], Iterable[int]]


def sun_picture(
    view: View,
    sun: np.ndarray,
    surface: Surface,
    walks: int,
    seed: int,
    progress: Progress = iter,
) -> dict[str, np.ndarray]:
    """Render the view under the sun in direction ``sun`` ``(3,)`` with ``walks`` walks a point.

    Returns pictures ``mean``, ``error`` (standard error of the mean), ``single`` (first bounce
    alone), and the ``mask`` ``(rows, columns)``; all 0 outside the mask. ``single`` is exact,
    except for diffuse facets, whose first bounce comes from the same walks. Pixels are independent.
    Values of walks are skewed. So a test over many pixels should divide the sum of differences by
    the root of summed squared errors, and not average each pixel's own ratio.
    """

    def shade(wi: np.ndarray, axes: Axes, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
        wo = to_local(sun, axes)
        lit = (wo[..., 2] != 0.0) if surface.material.transmits else (wo[..., 2] > 0.0)
        mean, variance, single = (np.zeros((*lit.shape, 3)) for _ in range(3))
        if lit.any():
            found = evaluate(wi[lit], wo[lit], surface, MAX_BOUNCES, walks, rng)
            mean[lit], variance[lit] = found.total, found.total_variance
            single[lit] = found.mean[0]
        return mean, variance, single

    return _render(shade, view, seed, progress)


def furnace_picture(
    view: View, surface: Surface, walks: int, seed: int, progress: Progress = iter
) -> dict[str, np.ndarray]:
    """Render the view in a uniform world of radiance 1; otherwise as `sun_picture`, but without
    ``single``."""

    def shade(wi: np.ndarray, axes: Axes, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
        found = energies(wi, surface, MAX_BOUNCES, walks, rng).both
        return found.total, found.total_variance, found.mean[0]

    picture = _render(shade, view, seed, progress)
    del picture["single"]
    return picture


def _render(
    shade: Callable[..., tuple[np.ndarray, ...]], view: View, seed: int, progress: Progress
) -> dict[str, np.ndarray]:
    """Average a shader's mean, variance and single bounce over the points of each masked pixel."""
    mean, variance, single = (np.zeros((*view.mask.shape, 3)) for _ in range(3))
    for row in progress(range(len(view.mask))):
        here = view.mask[row]
        if not here.any():
            continue
        rng = np.random.default_rng([seed, row])  # a row does not depend on other rows
        values, variances, singles = shade(*view.row(row), rng)
        mean[row, here] = values.mean(axis=1)
        variance[row, here] = variances.mean(axis=1) / variances.shape[1]
        single[row, here] = singles.mean(axis=1)
    mask = view.mask.astype(np.float64)
    return {"mean": mean, "error": np.sqrt(variance), "single": single, "mask": mask}
