# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' closures in numpy, as densities of reflected light: value times cosine, per steradian.

All take exits ``o`` ``(n, 3)`` above the horizon and return ``(n,)`` or, for ramps, one column a
knot. ``wi`` ``(3,)`` points to the viewer, the surface's normal is z. Written from Cycles' kernel
(src/kernel/closure, the same in 4.5 and 5.2), material setting Bump Map Correction on.
"""

import numpy as np
from scipy.special import erfcx

KNOTS = 8  # of a ramp


def normalized(v: np.ndarray) -> np.ndarray:
    """``v`` ``(..., 3)`` at unit length."""
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def knots(x: np.ndarray) -> np.ndarray:
    """Weights ``(n, KNOTS)`` of a ramp's knots at ``x`` ``(n,)`` in [0, 1], linear."""
    place = np.clip(x, 0.0, 1.0) * (KNOTS - 1)
    return np.maximum(1.0 - np.abs(place[:, None] - np.arange(KNOTS)), 0.0)


def diffuse_ramp(o: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """``(n, KNOTS)``: each knot's share in a ramp over the cosine to ``axis`` ``(3,)``, over pi.

    If ``axis`` is not the normal, Cycles fades a diffuse closure near the horizon by GGX masking.
    Its alpha^2 is an eighth of the squared tangent between axis and normal.
    """
    cosine = o @ axis
    alpha = np.sqrt(0.125 * max(1.0 / axis[2] ** 2 - 1.0, 0.0))
    shadow = 1.0 / (1.0 + _lambda(o, (alpha, alpha), False))
    return knots(cosine) * (np.where(cosine > 0.0, shadow, 0.0) / np.pi)[:, None]


def oren_nayar(o: np.ndarray, wi: np.ndarray) -> np.ndarray:
    """Oren and Nayar's lobe of roughness 1 (Fujii's form) for an energy of about 1, times its norm
    3/2 - 2/(3 pi), without interreflection."""
    z = o[:, 2]
    t = wi[0] * o[:, 0] + wi[1] * o[:, 1]
    return (z + t * np.where(t > 0.0, z / np.maximum(z, wi[2]), z)) / np.pi


def microfacet(
    o: np.ndarray, wi: np.ndarray, normal: np.ndarray, alpha: tuple[float, float], beckmann: bool
) -> np.ndarray:
    """A white reflection about ``normal`` ``(3,)``, which lies in the plane of incidence y = 0.

    ``alpha``: in that plane and across it; height-correlated masking. Light below the horizon of
    the normal or of the surface is lost.
    """
    x = np.array([normal[2], 0.0, -normal[0]])
    axes = np.stack([x, np.array([0.0, 1.0, 0.0]), normal])
    i, out = axes @ wi, o @ axes.T
    seen = (out[:, 2] > 0.0) & (o[:, 2] > 0.0)
    out = np.where(seen[:, None], out, [0.0, 0.0, 1.0])
    h = normalized(i + out)
    z2 = h[:, 2] ** 2
    slope2 = ((h[:, 0] / alpha[0]) ** 2 + (h[:, 1] / alpha[1]) ** 2) / z2
    density = np.exp(-slope2) if beckmann else (1.0 + slope2) ** -2
    density /= np.pi * alpha[0] * alpha[1] * z2 * z2
    masking = 1.0 + _lambda(i, alpha, beckmann) + _lambda(out, alpha, beckmann)
    return np.where(seen, density / (4.0 * i[2] * masking), 0.0)


def _lambda(w: np.ndarray, alpha: tuple[float, float], beckmann: bool) -> np.ndarray:
    """Smith's Lambda of directions above the horizon."""
    slope = np.hypot(w[..., 0] * alpha[0], w[..., 1] * alpha[1]) / w[..., 2]
    if not beckmann:
        return 0.5 * (np.hypot(1.0, slope) - 1.0)
    a = 1.0 / np.maximum(slope, 1e-12)
    return 0.5 * np.exp(-a * a) * (1.0 / (a * np.sqrt(np.pi)) - erfcx(a))
