# SPDX-License-Identifier: GPL-3.0-or-later
"""Pearson's chi-square test of draws against a density over a square of cells."""

from collections.abc import Callable

import numpy as np
from scipy.stats import chi2

from .quadrature import gauss_legendre

FEWEST = 5.0  # draws that a cell must expect for the statistic to follow its distribution


def sidak(tests: int, chance: float = 0.01) -> float:
    """The p-value under which a test fails, so that a family of ``tests`` tests fails a sampler
    that is right with ``chance``."""
    return -np.expm1(np.log1p(-chance) / tests)


def p_value(observed: np.ndarray, expected: np.ndarray) -> float:
    """Chance that draws which follow ``expected`` deviate from it as much as ``observed`` does.

    Both are counts in the same cells, any shape, the number of draws being fixed. The rarest cells
    are pooled until they, and each of the others, expect 5 draws. ``ValueError`` where fewer than
    two cells are left.
    """
    order = np.argsort(expected, axis=None)
    expected, observed = np.ravel(expected)[order], np.ravel(observed)[order]
    enough = np.searchsorted(np.cumsum(expected), FEWEST) + 1
    rare = max(enough, np.searchsorted(expected, FEWEST))
    if rare >= expected.size:
        raise ValueError(f"{expected.sum():.3g} draws are expected in all cells; draw more")
    expected = np.append(expected[:rare].sum(), expected[rare:])
    observed = np.append(observed[:rare].sum(), observed[rare:])
    return float(chi2.sf(((observed - expected) ** 2 / expected).sum(), expected.size - 1))


def count_in_cells(x: np.ndarray, y: np.ndarray, side: int) -> np.ndarray:
    """Number of points of the unit square ``(n,)`` in each of its cells, ``(side, side)``."""
    counts = np.histogram2d(x, y, side, [[0.0, 1.0], [0.0, 1.0]])[0]
    if counts.sum() != x.size:
        raise ValueError(f"{x.size - counts.sum():.0f} points are outside of the unit square")
    return counts


def integrate_cells(
    density: Callable[[np.ndarray, np.ndarray], np.ndarray], side: int, nodes: int = 12
) -> np.ndarray:
    """Integral of ``density(x, y)`` over each cell of the unit square, ``(side, side)``, by a Gauss
    rule of ``nodes`` x ``nodes`` points in every cell."""
    node, weight = gauss_legendre(nodes, 0.0, 1.0)
    x = ((np.arange(side)[:, None] + node) / side).ravel()
    value = density(*np.meshgrid(x, x, indexing="ij")).reshape(side, nodes, side, nodes)
    return np.einsum("iajb,a,b->ij", value, weight, weight) / side**2


def uniform_p_value(u: np.ndarray, cells: int = 100) -> float:
    """p-value of numbers ``(n,)`` in 0..1 that should be uniform: of a distribution function at its
    own draws."""
    observed = np.histogram(u, cells, (0.0, 1.0))[0]
    if observed.sum() != u.size:
        raise ValueError(f"{u.size - observed.sum()} numbers are outside of 0..1")
    return p_value(observed, np.full(cells, u.size / cells))
