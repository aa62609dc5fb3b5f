# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the BSDF by the one-way walk and by the bidirectional estimator, for random pairs of
directions."""

from dataclasses import dataclass

import numpy as np

from osl.oracle import bidirectional, estimate
from osl.oracle.surface import Surface
from osl.oracle.vectors import direction

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
        """wi and wo ``(pairs, 3)``, cosine-distributed.

        Every other wo is below the surface if it transmits.
        """
        u = np.random.default_rng(18).random((2, 2, self.pairs))
        wi, wo = direction(np.arccos(np.sqrt(1.0 - u[:, 0])), 2.0 * np.pi * u[:, 1])
        if self.surface.material.transmits:
            wo[::2] *= -1.0
        return wi, wo

    def run(self, seed: int) -> dict[str, np.ndarray]:
        """What `_both` finds, for all pairs."""
        return _both(*self.directions(), self.surface, (self.walks, self.walks), seed)


@dataclass(frozen=True)
class Settled:
    """Task: pair number ``pair`` of ``values`` once more.

    ``one_way``: the number of walks. ``both_ways``: the number of pairs of walks.
    """

    values: Estimators
    pair: int
    one_way: int
    both_ways: int

    @property
    def cost(self) -> int:
        """In walks of about the same time, for the progress bar."""
        return self.one_way + 10 * self.both_ways

    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """wi and wo ``(1, 3)``."""
        wi, wo = self.values.directions()
        return wi[self.pair, None], wo[self.pair, None]

    def run(self, seed: int) -> dict[str, np.ndarray]:
        """What `_both` finds, for one pair."""
        walks = self.one_way, self.both_ways
        return _both(*self.directions(), self.values.surface, walks, seed)


def _both(
    wi: np.ndarray, wo: np.ndarray, surface: Surface, walks: tuple[int, int], seed: int
) -> dict[str, np.ndarray]:
    """``mean`` and ``variance`` of the mean of bounces 2 to `MAX_BOUNCES`, by the walk and by the
    bidirectional estimator, ``(2, MAX_BOUNCES - 1, pairs)``."""
    rng = np.random.default_rng(seed)
    one_way = estimate.evaluate(wi, wo, surface, MAX_BOUNCES, walks[0], rng, roulette=0)
    both_ways = bidirectional.evaluate(wi, wo, surface, MAX_BOUNCES, walks[1], rng)
    found = one_way, both_ways
    return {
        "mean": np.stack([one.mean[1:, :, 0] for one in found]),
        "variance": np.stack([one.variance[1:, :, 0] for one in found]),
    }
