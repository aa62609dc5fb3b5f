# SPDX-License-Identifier: GPL-3.0-or-later
"""The samplers of visible micronormals against their density, by chi-square tests."""

import numpy as np
import pytest
from scipy.stats import chi2

from blender_tests.oracle.ndf import Dvis
from blender_tests.oracle.quadrature import gauss_legendre, stretched_normals
from blender_tests.oracle.surface import BECKMANN, GGX, Surface
from blender_tests.oracle.vectors import direction
from blender_tests.oracle.visible import from_uniforms, sample, slope_along, slope_distribution

CASES = [
    (GGX, 0.5, 0.5, 1.0),
    (GGX, 1.0, 0.1, 2.0),
    (GGX, 0.25, 0.25, 1.56),
    (BECKMANN, 1.0, 1.0, 0.0),
    (BECKMANN, 0.5, 0.5, 1.0),
    (BECKMANN, 0.5, 0.5, 1.65),
    (BECKMANN, 1.0, 0.1, 2.0),
]
# One chance in a hundred that the whole family of tests fails a right sampler (Sidak).
SIGNIFICANCE = 1.0 - (1.0 - 0.01) ** (1.0 / (2 * len(CASES)))
COUNTS = {"random": 100_000, "inverted": 20_000}  # bisection is slow
CELLS = 24  # on a side, in the coordinates of `stretched_normals`


def expected_counts(v, surface, count):
    """Draws expected in each cell, ``(CELLS, CELLS)``, by a 12 x 12 rule in every cell."""
    node, weight = gauss_legendre(12, 0.0, 1.0)
    q = ((np.arange(CELLS)[:, None] + node) / CELLS).ravel()
    psi = q * 2.0 * np.pi
    m, measure = stretched_normals(*np.meshgrid(q, psi, indexing="ij"), surface)
    value = Dvis(v, m, surface) * measure * 2.0 * np.pi / CELLS**2
    value = value.reshape(CELLS, 12, CELLS, 12)
    return count * np.einsum("iajb,a,b->ij", value, weight, weight)


def observed_counts(m, surface):
    x, y = m[:, 0] / (surface.alpha_x * m[:, 2]), m[:, 1] / (surface.alpha_y * m[:, 2])
    r = np.hypot(x, y)
    turns = np.mod(np.arctan2(y, x) / (2.0 * np.pi), 1.0)
    return np.histogram2d(r / (1.0 + r), turns, CELLS, [[0.0, 1.0], [0.0, 1.0]])[0]


def chi_square_p_value(observed, expected):
    """Cells that expect fewer than 5 are pooled."""
    rare = expected < 5.0
    pooled = np.append(expected[~rare], expected[rare].sum())
    counts = np.append(observed[~rare], observed[rare].sum())
    assert counts.sum() == observed.sum()
    keep = pooled > 0.0
    statistic = ((counts - pooled)[keep] ** 2 / pooled[keep]).sum()
    return chi2.sf(statistic, keep.sum() - 1)


@pytest.mark.parametrize("method", ["random", "inverted"])
@pytest.mark.parametrize(("distribution", "alpha_x", "alpha_y", "theta"), CASES)
def test_samples_follow_their_density(method, distribution, alpha_x, alpha_y, theta):
    surface = Surface(alpha_x, alpha_y, distribution)
    v = direction(theta, 0.5)
    rng = np.random.default_rng(20)
    count = COUNTS[method]
    many = np.broadcast_to(v, (count, 3))
    if method == "random":
        m = sample(many, surface, rng)
    else:
        m = from_uniforms(many, rng.random((count, 2)), surface)
    assert np.all(m[:, 2] > 0.0)
    np.testing.assert_allclose((m * m).sum(axis=1), 1.0, rtol=1e-12)
    p_value = chi_square_p_value(observed_counts(m, surface), expected_counts(v, surface, count))
    assert p_value > SIGNIFICANCE


def test_a_wrong_density_is_detected():
    # the test above has teeth: widths 3 % off must fail it
    v, count = direction(1.0), COUNTS["random"]
    m = sample(np.broadcast_to(v, (count, 3)), Surface(0.515, 0.515), np.random.default_rng(1))
    surface = Surface(0.5, 0.5)
    p_value = chi_square_p_value(observed_counts(m, surface), expected_counts(v, surface, count))
    assert p_value < SIGNIFICANCE


@pytest.mark.parametrize("a", [1e6, 5.0, 1.0, 0.3, 0.0, -0.3, -1.0, -10.0, -50.0])
def test_beckmann_slope_inverts_its_distribution(a):
    u = np.array([1e-12, 1e-3, 0.2, 0.5, 0.8, 0.999, 1.0 - 1e-9])
    x = slope_along(np.full(u.shape, a), u)
    assert np.all(x <= a)
    assert np.all(np.diff(x) > 0.0)
    # for a = -50 the slope's own rounding, 1e-16 of 50, moves the distribution by 1e-12
    np.testing.assert_allclose(slope_distribution(a, x), u, rtol=1e-11)
