# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the albedo of the facets with which a rough matte surface has a measured total albedo.

Light that a facet throws onto another is coloured again. With e_k the part of a white surface's
light that leaves at bounce k, the total albedo for facets of albedo r is the sum of e_k r^k. The
oracle walks give e_k, in light from all directions (weighted by the cosine, as an even sky's is).
"""

from functools import cache

import numpy as np

from osl.oracle import Diffuse, Surface, energies

# Two seeds differ by less than 0.001 in a total albedo (a test compares them).
_DIRECTIONS, _WALKS, _SEED = 64, 8192, 1
_MAX_BOUNCES = 64


@cache
def energy_by_bounce(roughness: float) -> np.ndarray:
    """Return e_1, e_2, ... of a white GGX surface; they sum to 1. `roughness` is 0 to 1."""
    if roughness < 0.01:  # flat: every facet throws all of its light out
        return np.array([1.0])
    squared = (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS  # of the cosine: the light of a sky
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
