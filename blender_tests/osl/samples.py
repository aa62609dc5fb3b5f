# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces and directions that the OSL tests cover, as float32 arrays, and the oracle's values."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from osl.oracle.surface import BECKMANN, GGX, MODELS, Surface

DISTRIBUTIONS = (GGX, BECKMANN)
ALPHAS = (0.001, 0.004, 0.02, 0.07, 0.25, 0.5, 0.8, 1.0)
ANISOTROPIES = (0.0, 0.5, 0.95)

# Makes `surface` of the OSL arguments below.
SURFACE = (
    "Microsurface surface; surface.alpha_x = alpha[0]; surface.alpha_y = alpha[1]; "
    "surface.isotropic = alpha[0] == alpha[1]; "
    "surface.beckmann = int(alpha[2]) % 2; surface.model = int(alpha[2]) / 2;"
)


def widths(surface: Surface) -> np.ndarray:
    """alpha_x, alpha_y, and one number for distribution and model, float32 (3,), as SURFACE takes
    them."""
    kind = 2 * MODELS.index(surface.model) + (surface.distribution == BECKMANN)
    return np.float32([surface.alpha_x, surface.alpha_y, kind])


def directions(count: int, rng: np.random.Generator) -> np.ndarray:
    """Unit vectors (count, 3) over the whole sphere: a third of them uniform, a third near the
    horizon and a third near the normal, on both sides, with distances even in their logarithm."""
    kind = np.arange(count) % 3
    side = np.where(rng.random(count) < 0.5, -1.0, 1.0)
    near = 10.0 ** rng.uniform(-5.0, -0.5, count)
    far = np.sqrt(1.0 - near * near)
    z = rng.uniform(-1.0, 1.0, count)
    sine = np.select([kind == 1, kind == 2], [far, near], np.sqrt(1.0 - z * z))
    z = np.select([kind == 1, kind == 2], [side * near, side * far], z)
    phi = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=-1).astype(np.float32)


def above(w: np.ndarray) -> np.ndarray:
    """The directions mirrored to the upper side."""
    return w * np.where(w[:, 2:] < 0.0, np.float32(-1.0), np.float32(1.0))


@dataclass(frozen=True)
class Rows:
    """One surface a block of rows, so that one render covers them all."""

    surfaces: tuple[Surface, ...]
    block: int

    @property
    def count(self) -> int:
        """Rows in all."""
        return len(self.surfaces) * self.block

    @property
    def alpha(self) -> np.ndarray:
        """`widths` of each row, float32 (count, 3)."""
        return np.repeat(np.array([widths(s) for s in self.surfaces]), self.block, axis=0)

    def oracle(self, function: Callable[..., np.ndarray], *columns: np.ndarray) -> np.ndarray:
        """`function(*columns of a block in float64, surface)` of every block, joined."""
        parts = []
        for index, surface in enumerate(self.surfaces):
            rows = slice(index * self.block, (index + 1) * self.block)
            parts.append(function(*(c[rows].astype(np.float64) for c in columns), surface))
        return np.concatenate(parts)


def all_surfaces(distribution: str, block: int) -> Rows:
    """Surfaces of alpha 0.001 to 1 and anisotropy 0 to 0.95, alpha limited to 1 as in Cycles."""
    surfaces = []
    for alpha in ALPHAS:
        for anisotropy in ANISOTROPIES:
            aspect = np.sqrt(1.0 - 0.9 * anisotropy)
            pair = np.float32(min(alpha / aspect, 1.0)), np.float32(alpha * aspect)
            surfaces.append(Surface(float(pair[0]), float(pair[1]), distribution))
    return Rows(tuple(surfaces), block)


def relative_error(found: np.ndarray, wanted: np.ndarray, floor: float) -> float:
    """Largest |found - wanted| / max(|wanted|, floor); fails on a value that is not finite."""
    assert np.all(np.isfinite(found))
    return float(np.max(np.abs(found - wanted) / np.maximum(np.abs(wanted), floor)))
