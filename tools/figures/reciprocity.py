# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of Fig. 17: values of the BSDF for pairs of directions, both ways.

If wi and wo were exchangeable, any model's differences would be centred on zero. So wi is always
the more grazing one of a pair.
"""

from dataclasses import dataclass

import numpy as np

from osl.oracle.estimate import evaluate
from osl.oracle.surface import Surface
from osl.oracle.vectors import direction

MAX_BOUNCES = 64


@dataclass(frozen=True)
class Reciprocity:
    """Task: the BSDF of ``surface`` both ways for the pairs ``first`` to ``first + pairs - 1``.

    Each value takes ``walks`` walks. A pair's number alone determines its directions.
    """

    surface: Surface
    first: int
    pairs: int
    walks: int

    @property
    def cost(self) -> int:
        """In walks of about the same time, for the progress bar."""
        return 4 * self.pairs * self.walks

    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """wi and wo ``(pairs, 3)``, cosine-distributed, wi the more grazing one."""
        numbers = range(self.first, self.first + self.pairs)
        u = np.array([np.random.default_rng([17, number]).random((2, 2)) for number in numbers])
        both = direction(np.arccos(np.sqrt(1.0 - u[..., 0])), 2.0 * np.pi * u[..., 1])
        order = np.argsort(both[..., 2], axis=1)[..., None]
        both = np.take_along_axis(both, order, axis=1)
        return both[:, 0], both[:, 1]

    def run(self, seed: int) -> dict[str, np.ndarray]:
        """``forward`` rho(wi, wo) and ``backward`` rho(wo, wi), summed over bounces, and the
        standard ``error`` of their difference, all ``(pairs,)``."""
        rng = np.random.default_rng(seed)
        wi, wo = self.directions()
        forward = evaluate(wi, wo, self.surface, MAX_BOUNCES, self.walks, rng)
        backward = evaluate(wo, wi, self.surface, MAX_BOUNCES, self.walks, rng)
        variance = (
            forward.total_variance[:, 0] / wo[:, 2] ** 2
            + backward.total_variance[:, 0] / wi[:, 2] ** 2
        )
        return {
            "forward": forward.total[:, 0] / wo[:, 2],
            "backward": backward.total[:, 0] / wi[:, 2],
            "error": np.sqrt(variance),
        }


@dataclass(frozen=True)
class Pairs:
    """The BSDF both ways ``(pairs,)``, and the standard error of the difference.

    Their quotient ``z`` is a unit normal for a reciprocal BSDF.
    """

    wi: np.ndarray
    wo: np.ndarray
    forward: np.ndarray
    backward: np.ndarray
    error: np.ndarray

    @classmethod
    def merge(cls, found: dict[Reciprocity, dict[str, np.ndarray]]) -> "Pairs":
        """The pairs of several tasks."""
        wi, wo = (np.concatenate(one) for one in zip(*(t.directions() for t in found), strict=True))
        rest = (
            np.concatenate([one[name] for one in found.values()])
            for name in ("forward", "backward", "error")
        )
        return cls(wi, wo, *rest)

    @property
    def difference(self) -> np.ndarray:
        """rho(wi, wo) - rho(wo, wi)."""
        return self.forward - self.backward

    @property
    def z(self) -> np.ndarray:
        """The difference in standard errors."""
        return self.difference / self.error

    @property
    def mean_difference(self) -> tuple[float, float]:
        """The mean of the differences and its standard error, from their scatter."""
        difference = self.difference
        return difference.mean(), difference.std(ddof=1) / np.sqrt(difference.size)
