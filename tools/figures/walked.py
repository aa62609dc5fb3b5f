# SPDX-License-Identifier: GPL-3.0-or-later
"""The lobes of a model, from its random walk."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from osl.oracle.estimate import batches
from osl.oracle.surface import Surface
from osl.oracle.walk import Vertex, bounces

from .lobes import MAX_BOUNCES, Sums, gather, incident


@dataclass(frozen=True)
class Walked:
    """Task: ``walks`` walks on ``surface``, with light from the angle ``theta``."""

    surface: Surface
    theta: float
    walks: int

    @property
    def cost(self) -> int:
        """Number of walks, for the progress bar."""
        return self.walks

    def run(self, seed: int) -> Sums:
        """The exits, gathered in an even number of parts."""
        rng = np.random.default_rng(seed)
        parts = 2 * max(4, len(list(batches(1, self.walks))) // 2)
        wi = np.broadcast_to(incident(self.theta), (self.walks // parts, 3))

        def runs() -> Iterator[Iterator[Vertex]]:
            for _ in range(parts):
                yield bounces(wi, self.surface, MAX_BOUNCES, rng)

        return gather(runs(), len(wi))
