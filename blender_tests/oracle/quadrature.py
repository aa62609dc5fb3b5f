# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrals over micronormals, directions and heights by fixed rules, which the tests hold against
formulas.

Micronormals are written m ~ (alpha_x r cos(psi), alpha_y r sin(psi), 1) with r = q/(1-q), so that a
rule over the unit square in (q, psi) resolves every alpha alike. Directions about a pole are
written with tan(angle/2) = width r, so that one square holds the whole sphere and resolves a lobe.
"""

import numpy as np
from scipy.special import log_ndtr

from .surface import Surface
from .vectors import vector


def gauss_legendre(count: int, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights ``(count,)`` of the Gauss-Legendre rule on an interval."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = 0.5 * (high - low)
    return low + half * (nodes + 1.0), half * weights


def stretched_normals(
    q: np.ndarray, psi: np.ndarray, surface: Surface
) -> tuple[np.ndarray, np.ndarray]:
    """Micronormals ``(..., 3)`` at ``q`` in (0, 1) and ``psi``, and steradians per dq dpsi."""
    r = q / (1.0 - q)
    x, y = surface.alpha_x * r * np.cos(psi), surface.alpha_y * r * np.sin(psi)
    length = np.sqrt(x * x + y * y + 1.0)
    measure = surface.alpha_x * surface.alpha_y * r / (length**3 * (1.0 - q) ** 2)
    return vector(x / length, y / length, 1.0 / length), measure


def stretched_coordinates(m: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """``q`` in (0, 1) and ``psi`` in turns, 0 to 1, of micronormals ``(..., 3)``."""
    x, y = m[..., 0] / (surface.alpha_x * m[..., 2]), m[..., 1] / (surface.alpha_y * m[..., 2])
    r = np.hypot(x, y)
    return r / (1.0 + r), np.mod(np.arctan2(y, x) / (2.0 * np.pi), 1.0)


def visible_normals(
    w: np.ndarray, surface: Surface, count: int = 200
) -> tuple[np.ndarray, np.ndarray]:
    """Rule over the micronormals that face ``w`` ``(3,)``: points ``(n, 3)``, weights ``(n,)``.

    w faces m where cos(psi - psi_w) > -a/r with a = w.z/t, which bounds psi for each r exactly; the
    integrand is then smooth inside. r runs from 0 to |a| and from |a| outwards, the square root at
    |a| smoothed by squaring the variable.
    """
    x, y = surface.alpha_x * w[0], surface.alpha_y * w[1]
    a = w[2] / max(np.hypot(x, y), 1e-12)
    joint = abs(a) / (1.0 + abs(a))  # |a| as a value of q
    s, weight = gauss_legendre(count, 0.0, 1.0)
    parts = [(joint + (1.0 - joint) * s * s, weight * 2.0 * s * (1.0 - joint))]
    if a > 0.0:
        parts.append((joint * (1.0 - s * s), weight * 2.0 * s * joint))
    q, q_weight = (np.concatenate(one) for one in zip(*parts, strict=True))
    bound = np.arccos(np.clip(-a * (1.0 - q) / q, -1.0, 1.0))
    node, node_weight = gauss_legendre(count, -1.0, 1.0)
    psi = np.arctan2(y, x) + bound[:, None] * node
    m, measure = stretched_normals(np.broadcast_to(q[:, None], psi.shape), psi, surface)
    total = measure * (q_weight * bound)[:, None] * node_weight
    return m.reshape(-1, 3), total.ravel()


def upper_hemisphere(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rule over directions above the horizon, even in z and azimuth: ``(n, 3)`` and ``(n,)``."""
    z, z_weight = gauss_legendre(count, 0.0, 1.0)
    phi = 2.0 * np.pi * (np.arange(2 * count) + 0.5) / (2 * count)
    radius = np.sqrt(1.0 - z * z)[:, None]
    w = vector(radius * np.cos(phi), radius * np.sin(phi), z[:, None])
    weight = np.broadcast_to(z_weight[:, None] * np.pi / count, w.shape[:-1])
    return w.reshape(-1, 3), weight.ravel()


def basis(pole: np.ndarray) -> np.ndarray:
    """Three orthonormal vectors as the rows of ``(3, 3)``, the last of which is ``pole``."""
    helper = np.eye(3)[np.argmin(np.abs(pole))]
    x = np.cross(helper, pole)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(pole, x), pole])


def directions_about(
    pole: np.ndarray, width: float, q: np.ndarray, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Directions ``(..., 3)`` of the whole sphere at ``q`` and ``turns`` in (0, 1), which resolve
    angles of 2 ``width`` about ``pole``, and steradians per dq dturns."""
    t = width * q / (1.0 - q)  # tan(angle/2)
    phi = 2.0 * np.pi * turns
    x, y, z = basis(pole)
    across = np.cos(phi)[..., None] * x + np.sin(phi)[..., None] * y
    o = (2.0 * t[..., None] * across + (1.0 - t * t)[..., None] * z) / (1.0 + t * t)[..., None]
    return o, 8.0 * np.pi * t * width / ((1.0 + t * t) * (1.0 - q)) ** 2


def coordinates_about(
    pole: np.ndarray, width: float, o: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The ``q`` and ``turns`` of directions ``o`` ``(n, 3)`` in `directions_about`."""
    x, y, z = basis(pole) @ o.T
    across = np.hypot(x, y)
    t = np.where(z > 0.0, across / (1.0 + np.abs(z)), (1.0 + np.abs(z)) / across)
    return t / (width + t), np.mod(np.arctan2(y, x) / (2.0 * np.pi), 1.0)


def zone(
    v: np.ndarray, angles: list[float], z_low: float, z_high: float, count: int = 120
) -> tuple[np.ndarray, np.ndarray]:
    """Rule over the directions o with ``z_low`` < o.z < ``z_high`` whose angle from ``v`` ``(3,)``
    lies between the first and the last of ``angles``: ``(n, 3)`` and ``(n,)``.

    The integrand may have a kink or a square root's end at each of ``angles``. The two planes bound
    the azimuth about v exactly, from the angles on at which their circles touch the cone.
    """
    theta = np.arccos(np.clip(v[2], -1.0, 1.0))
    planes = np.arccos(np.clip([z_low, z_high], -1.0, 1.0))
    touching = [*np.abs(planes - theta), *(np.pi - np.abs(np.pi - planes - theta))]
    inside = [a for a in touching if angles[0] < a < angles[-1]]
    ends = np.unique([*angles, *inside])
    node, node_weight = gauss_legendre(count, 0.0, 1.0)
    smooth, slope = node * node * (3.0 - 2.0 * node), 6.0 * node * (1.0 - node)
    angle = (ends[:-1, None] + np.diff(ends)[:, None] * smooth).ravel()
    angle_weight = (np.diff(ends)[:, None] * slope * node_weight).ravel()
    cosine, sine = np.cos(angle), np.sin(angle)
    bounds = (np.array([[z_high], [z_low]]) - cosine * v[2]) / (sine * max(np.sin(theta), 1e-12))
    first, last = np.arccos(np.clip(bounds, -1.0, 1.0))
    phi = first[:, None] + (last - first)[:, None] * node
    weight = (angle_weight * sine * (last - first))[:, None] * node_weight
    x = np.array([0.0, 0.0, 1.0]) - v[2] * v  # towards z, where phi is 0
    x = x / np.linalg.norm(x) if theta % np.pi > 1e-9 else basis(v)[0]
    along, y = cosine[:, None, None] * v, np.cross(v, x)
    towards = along + (sine[:, None] * np.cos(phi))[..., None] * x
    sideways = (sine[:, None] * np.sin(phi))[..., None] * y
    both = np.stack([towards + sideways, towards - sideways])
    return both.reshape(-1, 3), np.tile(weight.ravel(), 2)


def heights() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rule over the heights h of a Gaussian surface: log(u) and log(1 - u) of their distribution
    function u, and the weights' logarithms; each ``(n,)``.

    Trapezoids in t with h = sinh(t), which also resolve integrands u^(a-1) with a near 0 (h far
    down) or large (h far up), from a = 1e-7 to 1e6.
    """
    t = np.arange(-12.0, 4.5, 0.004)
    h = np.sinh(t)
    log_density = -0.5 * h * h - 0.5 * np.log(2.0 * np.pi)
    return log_ndtr(h), log_ndtr(-h), log_density + np.log(np.cosh(t) * 0.004)
