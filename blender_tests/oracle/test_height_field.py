# SPDX-License-Identifier: GPL-3.0-or-later
"""Random height fields have the statistics that they were made for.

One field is one sample, because its facets are correlated over some cells. So the scatter of many
fields gives the errors. Means must be within 4 standard errors of the right value.
"""

import numpy as np
import pytest
from scipy import stats

from osl.oracle.height_field import HeightField
from osl.oracle.ndf import D
from osl.oracle.quadrature import gauss_legendre
from osl.oracle.surface import BECKMANN, Surface
from osl.oracle.vectors import normalize, vector

pytestmark = pytest.mark.nightly

FIELDS = 64
SIDE = 64  # in correlation lengths
EDGES = np.array([-1.8, -1.2, -0.6, 0.0, 0.6, 1.2, 1.8])  # of cells of slopes, over alpha


def fields(surface, resolution, count=FIELDS):
    cells = int(SIDE * resolution)
    return (HeightField.gaussian(surface, cells, resolution, seed) for seed in range(count))


def deviation(samples, expected):
    """Mean over the first axis minus ``expected`` in standard errors, and the standard errors."""
    error = samples.std(axis=0, ddof=1) / np.sqrt(samples.shape[0])
    return (samples.mean(axis=0) - expected) / error, error


# a seed gives the same heights for every alpha, so more alphas would test nothing new
@pytest.mark.parametrize(("alpha", "resolution"), [((0.25, 0.25), 3), ((1.0, 0.1), 6)])
def test_slopes_have_the_moments_of_the_surface(alpha, resolution):
    surface = Surface(*alpha, BECKMANN)
    found = [field.slope_statistics() for field in fields(surface, resolution)]
    # heights at opposite ends are the same
    np.testing.assert_allclose([one.mean for one in found], 0.0, atol=1e-14)
    variance = np.array([one.variance for one in found]) / (0.5 * np.square(alpha))
    z, error = deviation(variance, 1.0)
    assert np.all(np.abs(z) < 4.0)
    # without the correction for finite differences it would be 1 - 1/(2 resolution^2), 0.945 of 3
    assert np.all(error < 0.004)
    # with all diagonals alike it would be 1/(2 resolution^2) in size, 0.055 of 3
    z, error = deviation(np.array([one.correlation for one in found]), 0.0)
    assert abs(z) < 4.0
    assert error < 0.003
    z, error = deviation(np.array([one.kurtosis for one in found]), 3.0)
    assert np.all(np.abs(z) < 4.0)
    assert np.all(error < 0.01)


def test_one_field_scatters_as_documented():
    # The slope along x has the autocorrelation (1 - 2 x^2) exp(-x^2 - y^2), lengths in tau. The
    # integral of its square is 3 pi/8, so a side of L has L^2 / (3 pi/8) independent samples.
    surface = Surface(0.5, 0.5, BECKMANN)
    variance = np.array([one.slope_statistics().variance for one in fields(surface, 4)]) / 0.125
    expected = np.sqrt(2.0 * 3.0 * np.pi / 8.0) / SIDE
    assert expected * SIDE == pytest.approx(1.5, abs=0.05)
    # 2 * 64 values give a standard deviation to 4 / sqrt(2 * 128) = 25 % at 4 standard errors
    assert variance.std(ddof=1) == pytest.approx(expected, rel=0.25)


def cell_shares(field, alpha):
    """Shares of the facets with slopes in each cell; facets have the same projected area."""
    slopes = field.facet_slopes().reshape(-1, 2) / alpha
    return np.histogram2d(*slopes.T, [EDGES, EDGES])[0] / slopes.shape[0]


def expected_shares(alpha, surface):
    """Projected area of micronormals in each cell, the integral of D(m) m.z over the cell."""
    node, weight = gauss_legendre(8, 0.0, 1.0)
    width = np.diff(EDGES)
    slope = (EDGES[:-1, None] + width[:, None] * node).ravel()
    x, y = np.meshgrid(slope * alpha[0], slope * alpha[1], indexing="ij")
    m = normalize(vector(-x, -y, np.ones_like(x)))
    # steradians per area of slopes: m.z^3
    density = D(m, surface) * m[..., 2] ** 4 * alpha[0] * alpha[1]
    weight = (width[:, None] * weight).ravel()
    cells = (density * np.outer(weight, weight)).reshape(width.size, 8, width.size, 8)
    return cells.sum(axis=(1, 3))


def test_slopes_follow_beckmanns_distribution():
    alpha = (1.0, 0.1)
    shares = np.array([cell_shares(one, alpha) for one in fields(Surface(*alpha, BECKMANN), 5)])
    # one chance in a hundred that the family of all cells fails a right field (Sidak)
    single = 1.0 - (1.0 - 0.01) ** (1.0 / shares[0].size)
    limit = stats.t.ppf(1.0 - 0.5 * single, FIELDS - 1)
    z, _ = deviation(shares, expected_shares(alpha, Surface(*alpha, BECKMANN)))
    assert np.abs(z).max() < limit
    # the test has teeth: a width 2 % off is found
    for wrong in (Surface(1.02, 0.1, BECKMANN), Surface(1.0, 0.098, BECKMANN)):
        z, _ = deviation(shares, expected_shares(alpha, wrong))
        assert np.abs(z).max() > limit


def test_heights_have_a_gaussian_autocorrelation():
    surface, resolution = Surface(1.0, 0.1, BECKMANN), 6
    lags = np.array([(0, 0), (3, 0), (0, 6), (6, 0), (4, -4), (6, 6), (12, 0)])
    found = np.array([one.autocorrelation(lags) for one in fields(surface, resolution)])
    # the mean height is taken out, which is pi / side^2 of the variance
    missing = np.pi / SIDE**2
    expected = (np.exp(-((lags / resolution) ** 2).sum(axis=1)) - missing) / (1.0 - missing)
    z, error = deviation(found, expected)
    assert np.all(np.abs(z) < 4.0)
    assert np.all(error < 0.005)


def test_correlation_lengths_belong_to_alpha():
    # tau = 2 / alpha for heights of standard deviation 1; a finite spacing takes 1/(4 resolution^2)
    field = HeightField.gaussian(Surface(0.8, 0.1, BECKMANN), 512, 16)
    np.testing.assert_allclose(16 * np.array(field.spacing), [2.5, 20.0], rtol=1.1 / 4 / 16**2)
    np.testing.assert_allclose(field.size, 32 * 16 * np.array(field.spacing), rtol=1e-14)


def test_the_seed_fixes_the_heights_for_every_alpha():
    one = HeightField.gaussian(Surface(1.0, 0.1, BECKMANN), 64, 4, 7)
    other = HeightField.gaussian(Surface(0.25, 0.25, BECKMANN), 64, 4, np.random.default_rng(7))
    np.testing.assert_array_equal(one.heights, other.heights)
    third = HeightField.gaussian(Surface(1.0, 0.1, BECKMANN), 64, 4, 8)
    assert np.all(one.heights != third.heights)


def test_mesh_has_the_slopes_of_the_facets():
    field = HeightField(np.random.default_rng(0).standard_normal((6, 4)), (0.5, 2.0))
    vertices, facets = field.mesh()
    a, b, c = (vertices[facets[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    np.testing.assert_allclose(normal[:, 2], 0.5 * 2.0, rtol=1e-12)  # counterclockwise, one area
    slopes = -normal[:, :2] / normal[:, 2:]
    np.testing.assert_allclose(field.facet_slopes().reshape(-1, 2), slopes, atol=1e-12)
    np.testing.assert_allclose(vertices.min(axis=0)[:2], -0.5 * field.size)
    np.testing.assert_allclose(vertices.max(axis=0)[:2], 0.5 * field.size)
    # every inner edge belongs to two facets, every edge of the border to one
    edges = np.sort(np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]]))
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert np.bincount(uses).tolist() == [0, 2 * (6 + 4), 3 * 24 - (6 + 4)]
    # opposite borders have the same heights
    z = vertices[:, 2].reshape(7, 5)
    np.testing.assert_array_equal(z[0], z[-1])
    np.testing.assert_array_equal(z[:, 0], z[:, -1])


def test_lists_of_whole_numbers_are_heights():
    field = HeightField([[0, 1], [0, 0]], [1, 2])
    assert field.heights.dtype == np.float64
    np.testing.assert_array_equal(field.facet_slopes()[0, 0], [[0.0, 0.0], [-1.0, 0.5]])
    assert field.slope_statistics().variance.shape == (2,)


def test_a_constant_slope_has_no_higher_moments():
    flat = HeightField(np.full((4, 4), 0.1), (1.0, 1.0)).slope_statistics()
    np.testing.assert_array_equal(flat.variance, 0.0)
    assert np.all(np.isnan([flat.correlation, *flat.kurtosis]))
    waves = np.repeat([[0.0], [1.0], [0.0], [-1.0]], 4, axis=1)
    found = HeightField(waves, (1.0, 1.0)).slope_statistics()
    np.testing.assert_array_equal(found.variance, [1.0, 0.0])
    assert np.isnan(found.correlation)
    np.testing.assert_array_equal(found.kurtosis, [1.0, np.nan])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: HeightField(np.zeros((4, 3)), (1.0, 1.0)), r"shape \(4, 3\)"),
        (lambda: HeightField(np.zeros(4), (1.0, 1.0)), r"shape \(4,\)"),
        (lambda: HeightField(np.full((4, 4), np.nan), (1.0, 1.0)), "not finite"),
        (lambda: HeightField(np.zeros((4, 4)), (1.0, 0.0)), r"spacing is \(1.0, 0.0\)"),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0)), "distribution is 'GGX'"),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 9, 2.0), "cells is 9"),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 40, 12.0), "cells is 40"),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 64, 1.5), "resolution is 1.5"),
        (
            lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 64, np.nan),
            "is nan; give 2",
        ),
        (
            lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 64, np.inf),
            "is inf; give 2",
        ),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 64.0, 8.0), "cells is 64.0"),
        (lambda: HeightField.gaussian(Surface(1.0, 1.0, BECKMANN), 64, 8.0, -1), "rng is -1"),
        (lambda: HeightField(np.zeros((4, 4), complex), (1.0, 1.0)), "type complex128"),
        (lambda: HeightField([["a", "b"], ["c", "d"]], (1.0, 1.0)), "type <U1"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()
