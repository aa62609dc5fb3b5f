# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectance of a surface of complex index n + i k, and three-channel values that stand for it.

The F82 tint is defined by the reflectance at normal incidence and at the cosine 1/7, about 82
degrees (Kutz, Hasan, Edmondson 2021, "Novel aspects of the Adobe Standard Material").
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from .colour import CHANNELS, WAVELENGTHS, colour
from .database import Spectrum

COS_82 = 1.0 / 7.0

# No finite index reflects everything, so effective indices reflect at most this.
MOST = 0.99

# A factor of e in an effective index costs as much as this error of reflectance. It decides between
# indices that look the same.
_PULL = 3e-3


@dataclass(frozen=True)
class Metal:
    """A metal in three channels, each array of shape (3).

    base_color, edge_tint -- of the F82 tint, in 0..1
    n, k                  -- effective indices that reflect `reflectance` and `reflectance_82`
    n_channel, k_channel  -- the measured indices at the wavelengths CHANNELS
    reflectance           -- linear Rec. 709 at normal incidence, before the limit to 0..1
    reflectance_82        -- the same at the cosine 1/7
    """

    base_color: np.ndarray
    edge_tint: np.ndarray
    n: np.ndarray
    k: np.ndarray
    n_channel: np.ndarray
    k_channel: np.ndarray
    reflectance: np.ndarray
    reflectance_82: np.ndarray


def reflectance(n: np.ndarray, k: np.ndarray, cosine: float) -> np.ndarray:
    """Return the unpolarised reflectance, in air, of n + i k at a cosine of incidence above 0."""
    eta2 = (np.asarray(n) + 1j * np.asarray(k)) ** 2
    refracted = np.sqrt(eta2 - (1.0 - cosine * cosine))  # eta times the cosine of refraction
    r_s = (cosine - refracted) / (cosine + refracted)
    r_p = (eta2 * cosine - refracted) / (eta2 * cosine + refracted)
    return 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)


def schlick(base: np.ndarray, cosine: float) -> np.ndarray:
    """Return Schlick's reflectance for the reflectance `base` at normal incidence."""
    return base + (1.0 - base) * (1.0 - cosine) ** 5


def metal(spectrum: Spectrum) -> Metal:
    """Return the three-channel values of a measured spectrum of n and k."""
    n, k = spectrum.n(WAVELENGTHS), spectrum.k(WAVELENGTHS)
    normal, edge = (colour(reflectance(n, k, cosine)) for cosine in (1.0, COS_82))
    base = np.clip(normal, 0.0, 1.0)
    tint = np.clip(edge / schlick(base, COS_82), 0.0, 1.0)
    channels = np.array(CHANNELS)
    n_channel, k_channel = spectrum.n(channels), spectrum.k(channels)
    effective = [
        effective_index(*values) for values in zip(base, edge, n_channel, k_channel, strict=True)
    ]
    n_effective, k_effective = np.array(effective).T
    return Metal(base, tint, n_effective, k_effective, n_channel, k_channel, normal, edge)


def effective_index(
    normal: float, edge: float, n_start: float, k_start: float
) -> tuple[float, float]:
    """Return the n and k that reflect `normal` at normal incidence and `edge` at the cosine 1/7.

    They are near n_start and k_start: least squares in the logarithms, by Levenberg and Marquardt.
    Reflectances above MOST count as MOST.
    """
    wanted = np.minimum((normal, edge), MOST)
    start = np.log(np.maximum((n_start, k_start), 1e-3))

    def residual(x: np.ndarray) -> np.ndarray:
        n, k = np.exp(x)
        found = np.array([reflectance(n, k, cosine) for cosine in (1.0, COS_82)])
        return np.concatenate((found - wanted, _PULL * (x - start)))

    fitted = least_squares(residual, start, method="lm", ftol=1e-12, xtol=1e-12, gtol=1e-12)
    n, k = np.exp(fitted.x)
    return float(n), float(k)


def transmittance(spectrum: Spectrum, thickness: float) -> np.ndarray:
    """Return the linear Rec. 709 colour in 0..1 of light through `thickness` mm.

    Reflection at the faces is left out.
    """
    path = thickness * 1e6  # nm
    passed = np.exp(-4.0 * np.pi * spectrum.k(WAVELENGTHS) * path / WAVELENGTHS)
    return np.clip(colour(passed), 0.0, 1.0)
