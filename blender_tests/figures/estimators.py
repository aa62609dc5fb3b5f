# SPDX-License-Identifier: GPL-3.0-or-later
"""What the bidirectional estimator gains over the one-way walk, for random pairs of directions."""

from dataclasses import dataclass

import numpy as np

from blender_tests.oracle import bidirectional, estimate
from blender_tests.oracle.surface import Surface
from blender_tests.oracle.vectors import direction

MAX_BOUNCES = 6


@dataclass(frozen=True)
class Estimators:
    """Task: ``pairs`` values of the BSDF of ``surface``, by both estimators with ``walks`` each."""

    surface: Surface
    pairs: int
    walks: int

    @property
    def cost(self) -> int:
        """In walks of about the same time, for the progress bar."""
        return 10 * self.pairs * self.walks

    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """wi and wo ``(pairs, 3)``, cosine-distributed; where the surface transmits, every other
        wo lies below it."""
        u = np.random.default_rng(18).random((2, 2, self.pairs))
        wi, wo = direction(np.arccos(np.sqrt(1.0 - u[:, 0])), 2.0 * np.pi * u[:, 1])
        if self.surface.material.transmits:
            wo[::2] *= -1.0
        return wi, wo

    def run(self, seed: int) -> dict[str, np.ndarray]:
        """``mean`` and ``variance`` of the mean of bounces 2 to `MAX_BOUNCES`, by the walk and by
        the bidirectional estimator, ``(2, MAX_BOUNCES - 1, pairs)``."""
        wi, wo = self.directions()
        rng = np.random.default_rng(seed)
        one_way = estimate.evaluate(wi, wo, self.surface, MAX_BOUNCES, self.walks, rng, roulette=0)
        both_ways = bidirectional.evaluate(wi, wo, self.surface, MAX_BOUNCES, self.walks, rng)
        found = one_way, both_ways
        return {
            "mean": np.stack([one.mean[1:, :, 0] for one in found]),
            "variance": np.stack([one.variance[1:, :, 0] for one in found]),
        }


@dataclass(frozen=True)
class Gain:
    """``ratio`` of the variances of walk and bidirectional estimator at equal numbers of walks,
    median over the pairs, for bounces 2, 3, ... ``(bounces - 1,)``; ``z`` ``(pairs,)``, the
    difference of their means over all these bounces in standard errors."""

    ratio: np.ndarray
    z: np.ndarray

    @classmethod
    def of(cls, found: dict[str, np.ndarray]) -> "Gain":
        """From the result of an `Estimators` task; pairs without light are left out."""
        one_way, both_ways = found["variance"]
        lit = (one_way > 0.0) & (both_ways > 0.0)
        ratio = np.where(lit, one_way / np.where(lit, both_ways, 1.0), np.nan)
        mean, variance = found["mean"].sum(axis=1), found["variance"].sum(axis=(0, 1))
        seen = variance > 0.0
        z = (mean[0] - mean[1])[seen] / np.sqrt(variance[seen])
        return cls(np.nanmedian(ratio, axis=1), z)
