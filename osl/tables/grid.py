# SPDX-License-Identifier: GPL-3.0-or-later
"""Where tables have their nodes, in alpha and in the view's cosine.

Further bounces depend on cosine / alpha if both are small, and on the view's angle if that is
small. So nodes are even in sqrt(alpha) and in x = sqrt(alpha (1 - cosine) / (alpha + cosine)), both
from 0 to 1. table.h has the same coordinates.
"""

import numpy as np

SMALLEST_ALPHA = 1e-6  # stands for 0 and means the limit in cosine / alpha
SMALLEST_RATIO = 1e-4  # cosine over alpha that stands for a view along the horizon


def alphas(count: int) -> np.ndarray:
    """The nodes' alpha ``(count,)``."""
    return np.maximum(np.linspace(0.0, 1.0, count) ** 2, SMALLEST_ALPHA)


def cosines(alpha: float, count: int) -> np.ndarray:
    """The view's cosine ``(count,)`` at the nodes of one alpha, from 1 down."""
    square = np.linspace(0.0, 1.0, count) ** 2
    return np.maximum(alpha * (1.0 - square) / (alpha + square), SMALLEST_RATIO * alpha)


def interpolated(table: np.ndarray, alpha: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Values ``(n, ...)`` of ``table`` ``(alphas, cosines, ...)`` between its nodes, linear in each
    half of the square between four nodes."""
    x = np.sqrt(alpha * (1.0 - cosine) / (alpha + cosine))
    places = [(np.sqrt(alpha), table.shape[0]), (x, table.shape[1])]
    (i, s), (j, t) = (_cell(one * (count - 1), count) for one, count in places)
    first = s > t
    nodes = (table[i, j], table[i + first, j + ~first], table[i + 1, j + 1])
    weights = (1.0 - np.maximum(s, t), np.abs(s - t), np.minimum(s, t))
    return sum(
        w.reshape(w.shape + (1,) * (table.ndim - 2)) * v
        for w, v in zip(weights, nodes, strict=True)
    )


def _cell(place: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    first = np.minimum(place.astype(int), count - 2)
    return first, place - first
