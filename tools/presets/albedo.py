# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the facet albedo that gives a rough matte surface its measured total albedo.

Facets colour the light again at each bounce. Let e_k be the part of a white surface's light that
leaves at bounce k. Facets of albedo r then give a total albedo of the sum of e_k r^k. The oracle's
walks measure e_k under an even sky, whose light is weighted by the cosine.
"""

from functools import cache

import numpy as np

from osl.oracle import Diffuse, Surface, energies

# Total albedos of two seeds differ by less than 0.001 (a test compares them).
_DIRECTIONS, _WALKS, _SEED = 64, 8192, 1
_MAX_BOUNCES = 64


@cache
def energy_by_bounce(roughness: float) -> np.ndarray:
    """Return e_1, e_2, ... of a white GGX surface; they sum to 1. `roughness` is 0 to 1."""
    if roughness < 0.01:  # flat: all light leaves at the first bounce
        return np.array([1.0])
    squared = (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS  # squared cosines, even under a sky
    wi = np.stack([np.sqrt(1.0 - squared), 0.0 * squared, np.sqrt(squared)], axis=1)
    alpha = roughness * roughness
    surface = Surface(alpha, alpha, material=Diffuse())
    found = energies(wi, surface, _MAX_BOUNCES, _WALKS, _SEED).both.mean[..., 0].mean(axis=1)
    return found / found.sum()


def total_albedo(facets: np.ndarray, roughness: float) -> np.ndarray:
    """Return the total albedo, of any shape, of facets of albedo `facets` in 0..1."""
    shares = energy_by_bounce(roughness)
    facets = np.asarray(facets, dtype=float)
    return sum(share * facets ** (k + 1) for k, share in enumerate(shares))


def facet_albedo(total: np.ndarray, roughness: float) -> np.ndarray:
    """Return the albedo of facets, of any shape, that gives the total albedo `total` in 0..1."""
    total = np.asarray(total, dtype=float)
    low, high = np.zeros_like(total), np.ones_like(total)
    for _ in range(40):
        middle = 0.5 * (low + high)
        dark = total_albedo(middle, roughness) < total
        low, high = np.where(dark, middle, low), np.where(dark, high, middle)
    return 0.5 * (low + high)
