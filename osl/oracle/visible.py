# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling micronormals from Dvis(v, .), for v above or below the horizon.

GGX takes spherical caps, which hold on the full sphere (Dupuy, Benyoub 2023, "Sampling Visible GGX
Normals with Spherical Caps"). Beckmann is stretched to alpha = 1. Then the slope across v is
Gaussian, and the slope x along v has density (a - x) exp(-x^2) for x < a. a is the cotangent of v's
angle (Heitz, d'Eon 2014). The walk draws x by rejection, which is exact. `from_uniforms` inverts
its distribution function to the last digits, so that samplers can be compared point by point.
"""

import numpy as np
from scipy.special import erfcx, ndtri

from .error_function import INV_SQRT_PI, deficit
from .surface import GGX, Surface
from .vectors import normalize, vector

_SQRT_PI = 1.0 / INV_SQRT_PI


def sample(v: np.ndarray, surface: Surface, rng: np.random.Generator) -> np.ndarray:
    """Micronormals ``(n, 3)`` drawn from Dvis(v, .), one for each of ``v`` ``(n, 3)``."""
    n = v.shape[0]
    if surface.distribution == GGX:
        return _ggx(v, surface, rng.random(n), rng.random(n))
    stretched, cotangent = _stretch(v, surface)
    along = _slope_by_rejection(cotangent, rng)
    across = rng.standard_normal(n) * np.sqrt(0.5)
    return _from_slopes(stretched, along, across, surface)


def from_uniforms(v: np.ndarray, u: np.ndarray, surface: Surface) -> np.ndarray:
    """Micronormals ``(n, 3)`` as a deterministic function of ``u`` ``(n, 2)`` in the open (0, 1).

    GGX: ``u0`` sets the cap's height, from its pole down, ``u1`` the azimuth about z in turns.
    Beckmann: ``u0`` is the distribution function of the slope along ``v``, rising from minus
    infinity to a; ``u1`` that of the slope across it.
    """
    if surface.distribution == GGX:
        return _ggx(v, surface, u[:, 0], u[:, 1])
    stretched, cotangent = _stretch(v, surface)
    across = np.sqrt(0.5) * ndtri(u[:, 1])
    return _from_slopes(stretched, slope_along(cotangent, u[:, 0]), across, surface)


def _ggx(v: np.ndarray, surface: Surface, u0: np.ndarray, u1: np.ndarray) -> np.ndarray:
    x, y, z = surface.alpha_x * v[:, 0], surface.alpha_y * v[:, 1], v[:, 2]
    t2 = x * x + y * y
    length = np.sqrt(t2 + z * z)
    # 1 + ws.z, without cancellation below the horizon
    lift = np.where(z > 0.0, length + z, t2 / (length + np.abs(z))) / length
    drop = u0 * lift  # 1 - c.z, for c.z uniform in (-ws.z, 1]
    radius = np.sqrt(drop * (2.0 - drop))
    phi = 2.0 * np.pi * u1
    hx = radius * np.cos(phi) + x / length
    hy = radius * np.sin(phi) + y / length
    hz = (1.0 - u0) * lift  # c.z + ws.z
    return normalize(vector(surface.alpha_x * hx, surface.alpha_y * hy, hz))


def _stretch(v: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Azimuth of v in the stretched frame as a unit vector ``(n, 2)``, and v's cotangent."""
    x, y = surface.alpha_x * v[:, 0], surface.alpha_y * v[:, 1]
    t = np.hypot(x, y)
    # straight up or down any azimuth will do; the capped cotangent leaves a pure Gaussian
    straight = t < 1e-150
    safe = np.where(straight, 1.0, t)
    azimuth = np.stack([np.where(straight, 1.0, x / safe), np.where(straight, 0.0, y / safe)])
    cotangent = np.clip(v[:, 2] / np.maximum(t, 1e-150), -1e150, 1e150)
    return azimuth.T, cotangent


def _from_slopes(
    azimuth: np.ndarray, along: np.ndarray, across: np.ndarray, surface: Surface
) -> np.ndarray:
    slope_x = azimuth[:, 0] * along - azimuth[:, 1] * across
    slope_y = azimuth[:, 1] * along + azimuth[:, 0] * across
    one = np.ones_like(along)
    # huge slopes (v far below the horizon) are scaled down so that their squares stay finite
    scale = 1.0 / np.maximum(1.0, np.maximum(np.abs(slope_x), np.abs(slope_y)))
    return normalize(
        vector(-surface.alpha_x * slope_x * scale, -surface.alpha_y * slope_y * scale, one * scale)
    )


def _slope_by_rejection(a: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Draw x < a with density proportional to (a - x) exp(-x^2)."""
    x = np.empty_like(a)
    left = np.arange(a.size)
    while left.size:
        proposal, chance = _propose(a[left], rng)
        accepted = rng.random(left.size) < chance
        x[left[accepted]] = proposal[accepted]
        left = left[~accepted]
    return x


def _propose(a: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A slope and the chance to accept it.

    a > 0: the Gaussian a exp(-x^2), plus |x| exp(-x^2) for x < 0; only 0 < x < a must be thinned.
    a <= 0, y = a - x: y exp(-y^2) exp(-2|a|y), as Rayleigh thinned by the last factor or as
    Gamma(2) thinned by the middle one, whichever accepts more (they cross at |a| = sqrt(1/2)).
    """
    n = a.size
    rayleigh = np.sqrt(rng.standard_exponential(n))
    gauss = rng.standard_normal(n) * np.sqrt(0.5)
    gamma = rng.standard_gamma(2.0, n)
    pick = rng.random(n) * (np.maximum(a, 0.0) * _SQRT_PI + 0.5) < 0.5
    up = np.where(pick, -rayleigh, gauss)
    up_chance = 1.0 - np.maximum(up, 0.0) / np.where(a > 0.0, a, 1.0)
    depth = np.maximum(-a, 0.0)
    near = depth < np.sqrt(0.5)
    y = np.where(near, rayleigh, gamma / np.where(near, 1.0, 2.0 * depth))
    down_chance = np.exp(-np.where(near, 2.0 * depth * y, y * y))
    return np.where(a > 0.0, up, a - y), np.where(a > 0.0, up_chance, down_chance)


def slope_distribution(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Distribution function at ``x <= a`` of the slope along v, in 0..1.

    It is ``S(x)/S(a)`` with ``S(x) = a erfc(-x)/2 + exp(-x^2)/(2 sqrt(pi))``.
    """
    a, x = np.broadcast_arrays(np.asarray(a, float), np.asarray(x, float))
    return np.where(a > 0.0, _upper_side(np.maximum(a, 0.0), x), _lower_side(-a, a - x))


def slope_along(a: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Slope x < a whose distribution function is ``u`` in (0, 1), by bisection to the last bit.

    The unknown is x for a > 0 and y = a - x for a <= 0, so no digits are lost.
    """
    a, u = np.broadcast_arrays(np.asarray(a, float), np.asarray(u, float))
    up, depth = np.maximum(a, 0.0), np.maximum(-a, 0.0)
    # exp(-40^2) is far below the smallest double, and so is exp(-y (y + 2 |a|)) at the upper bound
    low = np.where(a > 0.0, -40.0, 0.0)
    high = np.where(a > 0.0, np.minimum(a, 40.0), 1600.0 / (40.0 + depth))
    for _ in range(75):
        middle = 0.5 * (low + high)
        under = np.where(a > 0.0, _upper_side(up, middle) < u, _lower_side(depth, middle) > u)
        low = np.where(under, middle, low)
        high = np.where(under, high, middle)
    return np.where(a > 0.0, middle, a - middle)


def _upper_side(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """S(x)/S(a) for a > 0."""
    b = np.abs(x)
    gauss = 0.5 * np.exp(-np.minimum(b * b, 745.0))
    tail = a * erfcx(b)
    value = np.where(x > 0.0, a + gauss * (INV_SQRT_PI - tail), gauss * (INV_SQRT_PI + tail))
    total = a + 0.5 * np.exp(-(np.minimum(a, 27.0) ** 2)) * deficit(a)
    return value / total


def _lower_side(depth: np.ndarray, y: np.ndarray) -> np.ndarray:
    """S(a - y)/S(a) for a = -depth <= 0, both divided by exp(-a^2), which may underflow."""
    depth, y = np.maximum(depth, 0.0), np.maximum(y, 0.0)
    b = depth + y
    return np.exp(-y * (y + 2.0 * depth)) * (deficit(b) + y * erfcx(b)) / deficit(depth)
