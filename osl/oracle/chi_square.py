# SPDX-License-Identifier: GPL-3.0-or-later
"""Pearson's chi-square test of draws against a density, over a grid of cells."""

from collections.abc import Callable

import numpy as np
from scipy.stats import chi2

from .quadrature import gauss_legendre

FEWEST = 5.0  # expected draws a cell needs, so that the statistic is chi-square distributed


def sidak(tests: int, chance: float = 0.01) -> float:
    """The p-value below which each of ``tests`` tests fails (Sidak's correction).

    A right sampler then fails one or more of them with ``chance``.
    """
    return -np.expm1(np.log1p(-chance) / tests)


def p_value(observed: np.ndarray, expected: np.ndarray) -> float:
    """The chance that right draws deviate from ``expected`` at least as much as ``observed`` does.

    Both are counts in the same cells, of any shape, for a fixed number of draws. The rarest cells
    are pooled until every cell expects 5 draws. ``ValueError`` if fewer than two cells are left.
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


def count_in_cells(
    x: np.ndarray, y: np.ndarray, x_edges: np.ndarray, y_edges: np.ndarray
) -> np.ndarray:
    """Number of points ``(n,)`` in each cell between the edges, ``(columns, rows)``."""
    counts = np.histogram2d(x, y, [x_edges, y_edges])[0]
    if counts.sum() != x.size:
        raise ValueError(
            f"{x.size - counts.sum():.0f} points lie outside all cells; widen the edges"
        )
    return counts


def integrate_cells(
    density: Callable[[np.ndarray, np.ndarray], np.ndarray],
    x_edges: np.ndarray,
    y_edges: np.ndarray,
    nodes: int = 12,
) -> np.ndarray:
    """Integral of ``density(x, y)`` over each cell between the edges, ``(columns, rows)``.

    Each cell takes a Gauss rule of ``nodes`` x ``nodes`` points.
    """
    node, weight = gauss_legendre(nodes, 0.0, 1.0)
    width, height = np.diff(x_edges), np.diff(y_edges)
    x = (x_edges[:-1, None] + width[:, None] * node).ravel()
    y = (y_edges[:-1, None] + height[:, None] * node).ravel()
    value = density(*np.meshgrid(x, y, indexing="ij"))
    value = value.reshape(width.size, nodes, height.size, nodes)
    return np.einsum("iajb,a,b->ij", value, weight, weight) * width[:, None] * height


def uniform_p_value(u: np.ndarray, cells: int = 100) -> float:
    """p-value of the claim that ``u`` ``(n,)`` is uniform in 0..1.

    A distribution function is uniform at its own draws.
    """
    observed = np.histogram(u, cells, (0.0, 1.0))[0]
    if observed.sum() != u.size:
        raise ValueError(f"{u.size - observed.sum()} numbers are outside 0..1; rescale them")
    return p_value(observed, np.full(cells, u.size / cells))
