# SPDX-License-Identifier: GPL-3.0-or-later
"""The reflectance of a metal's facets, averaged over the directions of the light."""

from collections.abc import Callable, Sequence

Colour = tuple[float, float, float]

# The mean over a hemisphere of light takes this many equal parts of sin^2.
_PARTS = 16
_COS_82 = 1.0 / 7.0  # where the edge tint is defined


def mean_of_tint(base: Sequence[float], edge: Sequence[float]) -> Colour:
    """Return the mean reflectance, 0 to 1, of the F82 tint with base colour and edge tint in 0..1.

    Kutz, Hasan, Edmondson 2021: Schlick's factor, lowered near 82 degrees to `edge` times itself.
    """

    def channel(f0: float, tint: float) -> float:
        rest = 1.0 - _COS_82
        lower = (f0 + (1.0 - f0) * rest**5) * (1.0 - tint) / (_COS_82 * rest**6)
        return _mean(lambda c: f0 + (1.0 - f0) * (1.0 - c) ** 5 - lower * c * (1.0 - c) ** 6)

    return tuple(channel(f0, tint) for f0, tint in zip(base, edge, strict=True))


def mean_of_index(n: Sequence[float], k: Sequence[float]) -> Colour:
    """Return the mean reflectance, 0 to 1, of a metal of index n + i k in air (both 0 or more)."""

    def channel(n: float, k: float) -> float:
        eta2 = complex(n, k) ** 2

        def at(c: float) -> float:
            q = (eta2 - (1.0 - c * c)) ** 0.5
            r_s, r_p = (c - q) / (c + q), (eta2 * c - q) / (eta2 * c + q)
            return 0.5 * (abs(r_s) ** 2 + abs(r_p) ** 2)

        return _mean(at) if n + k > 0.0 else 1.0

    return tuple(channel(*pair) for pair in zip(n, k, strict=True))


def _mean(reflectance: Callable[[float], float]) -> float:
    cosines = (((i + 0.5) / _PARTS) ** 0.5 for i in range(_PARTS))
    return sum(min(max(reflectance(c), 0.0), 1.0) for c in cosines) / _PARTS
