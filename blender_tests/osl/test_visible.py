# SPDX-License-Identifier: GPL-3.0-or-later
"""The sampling of visible normals (visible.h) against the oracle's inverse and distribution."""

from statistics import NormalDist

import numpy as np
import pytest

from osl.oracle.surface import BECKMANN, GGX
from osl.oracle.visible import from_uniforms, slope_along, slope_distribution

from .probe import evaluate
from .samples import DISTRIBUTIONS, SURFACE, Rows, all_surfaces, directions, relative_error

SAMPLE = f"{SURFACE} result = sample_visible_normal(surface, incidence(surface, view), xi);"


def test_ggx_normals_are_the_oracles() -> None:
    """The same uniform numbers give the same micronormal, from above and from below.

    The tolerance is absolute, in the slope space of alpha 1, where a micronormal of any alpha is
    of order one. It leaves out the last 0.1 % towards the rim of the cap, where the normal lies so
    flat that single precision does not hold its height.
    """
    rows = all_surfaces(GGX, block=400)
    rng = np.random.default_rng(4)
    v = directions(rows.count, rng)
    u = rng.uniform(0.001, 0.999, (rows.count, 3)).astype(np.float32)
    found = evaluate("visible.h", SAMPLE, alpha=rows.alpha, view=v, xi=u)
    wanted = rows.oracle(lambda v, u, s: from_uniforms(v, u[:, :2], s), v, u)
    assert relative_error(np.linalg.norm(found, axis=-1), np.ones(rows.count), 1.0) < 1e-6
    assert np.all(found[:, 2] >= 0.0)
    unit = _stretched(found, rows), _stretched(wanted, rows)
    assert np.max(np.abs(unit[0] - unit[1])) < 1e-4


def _stretched(m: np.ndarray, rows: Rows) -> np.ndarray:
    """Micronormals as the surface of alpha 1 has them, unit vectors."""
    h = np.concatenate([m[:, :2] / rows.alpha[:, :2].astype(float), m[:, 2:]], axis=-1)
    return h / np.linalg.norm(h, axis=-1, keepdims=True)


def test_beckmann_tail_is_the_oracles() -> None:
    """The slope beyond the cotangent a, solved in single precision, for u over (0, 1)."""
    rng = np.random.default_rng(5)
    a = np.concatenate([10.0 ** rng.uniform(-6.0, 3.0, 3000), [0.0, 1.0, 1e4]])
    u = np.concatenate([rng.random(2000), 10.0 ** rng.uniform(-6.0, 0.0, 1003)])
    a, u = a.astype(np.float32), np.maximum(u, 1e-6).astype(np.float32)
    found = evaluate("visible.h", "result = beckmann_tail_slope(a, xi);", a=a, xi=u)[:, 0]
    wanted = -slope_along(-a.astype(float), u.astype(float)) - a.astype(float)
    # Near u = 1 the slope goes like sqrt(1 - u), which float32 gives in steps of 6e-8.
    resolved = u < 0.999
    # The oracle's x - a loses digits to a itself, here at most 1e3 * 1e-16 of 1e-3.
    assert relative_error(found[resolved], wanted[resolved], 1e-6) < 1e-4
    assert np.all(found > 0.0)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("alpha", [(0.3, 0.3), (1.0, 0.1)])
@pytest.mark.parametrize("cosine", [1.0, 0.6, 0.05, -0.05, -0.5])
def test_visible_normals_are_distributed_as_dvis(
    distribution: str, alpha: tuple[float, float], cosine: float
) -> None:
    """Chi-square over 12 x 12 cells of equal probability.

    For Beckmann the slopes along and across the incidence are independent with known distribution
    functions; for GGX the oracle's mapping is inverted: height and azimuth on the cap are uniform.
    """
    count, cells = 20_000, 12
    rng = np.random.default_rng(6)
    sine = np.sqrt(1.0 - cosine * cosine)
    v = np.tile(np.float32([sine * 0.8, sine * 0.6, cosine]), (count, 1))
    widths = np.tile(np.float32([*alpha, distribution == BECKMANN]), (count, 1))
    u = rng.random((count, 3)).astype(np.float32)
    m = evaluate("visible.h", SAMPLE, alpha=widths, view=v, xi=u).astype(float)
    uniform = _uniform_pair(m, v[0].astype(float), np.array(alpha), distribution)
    table, _, _ = np.histogram2d(*uniform.T, bins=cells, range=[[0, 1], [0, 1]])
    expected = count / cells**2
    statistic = np.sum((table - expected) ** 2) / expected
    # Wilson and Hilferty: the cube root of chi-square / k is nearly normal.
    k = cells**2 - 1
    z = ((statistic / k) ** (1 / 3) - (1 - 2 / (9 * k))) / np.sqrt(2 / (9 * k))
    tests = len(DISTRIBUTIONS) * 2 * 5
    significance = 1.0 - (1.0 - 0.01) ** (1.0 / tests)  # Sidak
    assert z < NormalDist().inv_cdf(1.0 - significance), f"chi-square {statistic:.0f}, {k} cells"


def _uniform_pair(m: np.ndarray, v: np.ndarray, alpha: np.ndarray, distribution: str) -> np.ndarray:
    """Numbers (n, 2) that are uniform and independent if m follows Dvis(v, .)."""
    w = np.array([alpha[0] * v[0], alpha[1] * v[1], v[2]])
    w /= np.linalg.norm(w)
    sine = np.hypot(w[0], w[1])
    azimuth = w[:2] / sine if sine > 1e-7 else np.array([1.0, 0.0])
    if distribution == GGX:
        h = np.stack([m[:, 0] / alpha[0], m[:, 1] / alpha[1], m[:, 2]], axis=-1)
        h /= np.linalg.norm(h, axis=-1, keepdims=True)
        c = 2.0 * (h @ w)[:, None] * h - w  # h is halfway between c and w
        height = (1.0 - c[:, 2]) / (1.0 + w[2])
        return np.stack([height, np.arctan2(c[:, 1], c[:, 0]) / (2 * np.pi) % 1.0], axis=-1)
    slopes = -m[:, :2] / (alpha * m[:, 2:])
    along = slopes @ azimuth
    across = slopes @ np.array([-azimuth[1], azimuth[0]])
    cotangent = w[2] / max(sine, 1e-7)
    gauss = np.vectorize(NormalDist(sigma=np.sqrt(0.5)).cdf)
    return np.stack([slope_distribution(cotangent, along), gauss(across)], axis=-1)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_extremes_are_unit_vectors(distribution: str) -> None:
    """Random numbers 0 and 1, alpha from 1e-4, directions straight up and at the horizon."""
    ends = [0.0, 1e-7, 0.5, 1.0]
    u = np.array(np.meshgrid(ends, ends, ends)).reshape(3, -1).T
    z = np.array([1.0, 0.5, 1e-6, 0.0, -1e-6, -0.5])
    v = np.stack([np.sqrt(1.0 - z * z), np.zeros_like(z), z], axis=-1)
    alphas = np.array([[1e-4, 1e-4], [1.0, 1.0], [1.0, 0.1]])
    index = np.array(np.meshgrid(np.arange(len(u)), np.arange(len(v)), np.arange(len(alphas))))
    i, j, k = index.reshape(3, -1)
    widths = np.column_stack([alphas[k], np.full(len(k), float(distribution == BECKMANN))])
    found = evaluate("visible.h", SAMPLE, alpha=widths, view=v[j], xi=u[i])
    length = np.linalg.norm(found, axis=-1)
    # u0 = 1 is GGX's rim of the cap, where h may vanish; the vertex then goes straight back.
    assert np.all((np.abs(length - 1.0) < 1e-6) | ((u[i, 0] == 1.0) & (length == 0.0)))
    assert np.all(found[:, 2] >= 0.0)
