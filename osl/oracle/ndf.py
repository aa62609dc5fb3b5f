# SPDX-License-Identifier: GPL-3.0-or-later
"""The NDF and what follows from it: D, sigma, Lambda, Dvis.

All of Smith's theory on the full sphere follows from sigma(w), the projected area of the
micronormals that face w. It is finite everywhere, so nothing here divides by a cosine.
"""

import numpy as np

from .error_function import deficit
from .surface import GGX, Surface
from .vectors import dot, unit_vectors


def D(m: np.ndarray, surface: Surface) -> np.ndarray:
    """Density of micronormals ``m`` ``(..., 3)`` per steradian and unit of macrosurface, ``(...)``.

    0 where ``m.z <= 0``. Its integral weighted with ``m.z`` is 1. Walter et al. 2007, eqs. 25
    (Beckmann) and 33 (GGX), stretched along x and y. `D` and `sigma` do not check their
    directions, because the walk calls them for every vertex.
    """
    m = np.asarray(m, dtype=np.float64)
    z = np.maximum(m[..., 2], 0.0)
    slope2 = (m[..., 0] / surface.alpha_x) ** 2 + (m[..., 1] / surface.alpha_y) ** 2
    norm = np.pi * surface.alpha_x * surface.alpha_y
    if surface.distribution == GGX:
        quad = slope2 + z * z
        return np.where(z > 0.0, 1.0 / (norm * np.where(quad == 0.0, 1.0, quad) ** 2), 0.0)
    # exp(-slope2/z^2) underflows long before z^4 does, so a floor on z only avoids 0/0
    z2 = np.maximum(z, 1e-30) ** 2
    return np.where(z > 0.0, np.exp(-np.minimum(slope2 / z2, 750.0)) / (norm * z2 * z2), 0.0)


def sigma(w: np.ndarray, surface: Surface) -> np.ndarray:
    """Projected area of micronormals facing ``w``: integral of <w,m> D(m) dm, shape ``(...)``.

    The denominator of eq. 4. Equals ``(1 + Lambda(w)) w.z`` (eqs. 1-3), >= 0 on the whole sphere.
    It is ``w.z + sigma(-w)`` above the horizon, so only directions below need a formula without
    cancellation.
    """
    w = np.asarray(w, dtype=np.float64)
    z = w[..., 2]
    t2 = (surface.alpha_x * w[..., 0]) ** 2 + (surface.alpha_y * w[..., 1]) ** 2
    depth = np.abs(z)
    if surface.distribution == GGX:
        below = t2 / (2.0 * (np.sqrt(z * z + t2) + depth))
    else:
        t = np.sqrt(t2)
        # 30 is past the underflow of exp(-a^2); the cap keeps t = 0 and huge a free of inf * 0
        a = np.minimum(depth / np.maximum(t, 1e-300), 30.0)
        below = np.where(depth > 28.0 * t, 0.0, 0.5 * t * np.exp(-a * a) * deficit(a))
    return np.maximum(z, 0.0) + below


def Lambda(w: np.ndarray, surface: Surface) -> np.ndarray:
    """Smith's Lambda for ``w.z != 0`` on either side of the horizon (eq. 2): sigma(w)/w.z - 1.
    ``ValueError`` for a ``w`` that is not a unit vector."""
    w = unit_vectors(w, "w")
    upper = w[..., 2] > 0.0
    facing = np.where(upper, 1.0, -1.0)[..., None] * w
    above = sigma(-facing, surface) / facing[..., 2]
    return np.where(upper, above, -1.0 - above)


def Dvis(v: np.ndarray, m: np.ndarray, surface: Surface) -> np.ndarray:
    """Density per steradian of the micronormals ``m`` that ``v`` sees: <v,m> D(m) / sigma(v).

    ``v`` may lie below the horizon. Raises ``ValueError`` for directions that are not unit vectors,
    and if v sees no micronormal in double precision (sigma(v) = 0).
    """
    v, m = unit_vectors(v, "v"), unit_vectors(m, "m")
    area = sigma(v, surface)
    if np.any(area == 0.0):
        raise ValueError(f"v contains {v[area == 0.0][0]}, from which no micronormal is visible")
    return np.maximum(dot(v, m), 0.0) * D(m, surface) / area
