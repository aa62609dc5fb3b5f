# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrals over micronormals and directions by fixed rules, which the tests hold against formulas.

Micronormals are written m ~ (alpha_x r cos(psi), alpha_y r sin(psi), 1) with r = q/(1-q), so that a
rule over the unit square in (q, psi) resolves every alpha alike.
"""

import numpy as np

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
