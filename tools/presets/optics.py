# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface of complex index n + i k reflects, and the three-channel values that stand for it.

The F82 tint is defined by the reflectance at normal incidence and at the cosine 1/7, about 82
degrees (Kutz, Hasan, Edmondson 2021, "Novel aspects of the Adobe Standard Material").
"""

from dataclasses import dataclass

import numpy as np

from .colour import CHANNELS, WAVELENGTHS, colour
from .database import Spectrum

COS_82 = 1.0 / 7.0

# The effective indices reflect at most this, which a finite index can.
MOST = 0.99

# How much, as an error of reflectance, a factor of e in an effective index counts: it decides
# between indices that look the same.
_PULL = 3e-3


@dataclass(frozen=True)
class Metal:
    """A metal in three channels, each array of shape (3).

    base_color, edge_tint -- of the F82 tint, in 0..1
    n, k                  -- effective indices, which reflect `reflectance` and `reflectance_82`
    n_channel, k_channel  -- the measured indices at the wavelengths CHANNELS
    reflectance           -- linear Rec. 709 at normal incidence before it was limited to 0..1
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
    """Return the n and k, near n_start and k_start, that reflect `normal` at normal incidence and
    `edge` at the cosine 1/7: least squares in the logarithms of both, by Levenberg and Marquardt.

    Reflectances above MOST are taken for MOST.
    """
    wanted = np.array((min(normal, MOST), min(edge, MOST)))
    start = np.log((max(n_start, 1e-3), max(k_start, 1e-3)))

    def residual(x: np.ndarray) -> np.ndarray:
        n, k = np.exp(x)
        found = np.array([reflectance(n, k, cosine) for cosine in (1.0, COS_82)])
        return np.concatenate((found - wanted, _PULL * (x - start)))

    x, damping = start.copy(), 1e-3
    error = residual(x)
    for _ in range(200):
        step = 1e-6
        slopes = np.array([(residual(x + d) - error) / step for d in step * np.eye(2)]).T
        square = slopes.T @ slopes
        change = np.linalg.solve(square + damping * np.diag(np.diag(square)), -slopes.T @ error)
        trial = residual(x + change)
        if trial @ trial < error @ error:
            x, error, damping = x + change, trial, 0.3 * damping
        else:
            damping *= 5.0
        if np.abs(change).max() < 1e-9:
            break
    n, k = np.exp(x)
    return float(n), float(k)


def transmittance(spectrum: Spectrum, thickness: float) -> np.ndarray:
    """Return the linear Rec. 709 colour in 0..1 of light through `thickness` mm, without the
    losses by reflection at its faces."""
    path = thickness * 1e6  # nm
    passed = np.exp(-4.0 * np.pi * spectrum.k(WAVELENGTHS) * path / WAVELENGTHS)
    return np.clip(colour(passed), 0.0, 1.0)
