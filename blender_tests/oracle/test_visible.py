# SPDX-License-Identifier: GPL-3.0-or-later
"""The samplers of visible micronormals against their density, by chi-square tests."""

import numpy as np
import pytest

from osl.oracle.chi_square import count_in_cells, integrate_cells, p_value, sidak
from osl.oracle.ndf import Dvis
from osl.oracle.quadrature import stretched_coordinates, stretched_normals
from osl.oracle.surface import BECKMANN, GGX, Surface
from osl.oracle.vectors import direction
from osl.oracle.visible import from_uniforms, sample, slope_along, slope_distribution

WIDTHS = [(0.05, 0.05), (0.25, 0.25), (0.5, 0.5), (1.0, 1.0), (1.0, 0.1)]
# from straight up over both sides of the horizon to far below it
ANGLES = [0.0, 1.0, 1.56, 1.65, 2.0]
# where Beckmann facets are in sight at all they fill too few cells for a test (exp(-9^2) of them)
CASES = [
    (ndf, *alpha, theta)
    for ndf in (GGX, BECKMANN)
    for alpha in WIDTHS
    for theta in ANGLES
    if not (ndf == BECKMANN and alpha == (0.05, 0.05) and theta == 2.0)
]
DRAWS = {"random": 200_000, "inverted": 10_000}  # bisection is slow
# One chance in a hundred that the whole family of tests fails a right sampler.
SIGNIFICANCE = sidak(len(DRAWS) * len(CASES))
EDGES = np.linspace(0.0, 1.0, 25)  # of cells in the coordinates of `stretched_normals`


def visible_p_value(m, v, surface):
    """p-value that micronormals ``m`` follow Dvis(v, .)."""

    def density(q, turns):
        points, measure = stretched_normals(q, 2.0 * np.pi * turns, surface)
        return Dvis(v, points, surface) * measure * 2.0 * np.pi

    expected = m.shape[0] * integrate_cells(density, EDGES, EDGES)
    return p_value(count_in_cells(*stretched_coordinates(m, surface), EDGES, EDGES), expected)


@pytest.mark.parametrize("method", DRAWS)
@pytest.mark.parametrize(("distribution", "alpha_x", "alpha_y", "theta"), CASES)
def test_samples_follow_their_density(method, distribution, alpha_x, alpha_y, theta):
    surface = Surface(alpha_x, alpha_y, distribution)
    v = direction(theta, 0.5)
    rng = np.random.default_rng(20)
    many = np.broadcast_to(v, (DRAWS[method], 3))
    if method == "random":
        m = sample(many, surface, rng)
    else:
        m = from_uniforms(many, rng.random((DRAWS[method], 2)), surface)
    assert np.all(m[:, 2] > 0.0)
    np.testing.assert_allclose((m * m).sum(axis=1), 1.0, rtol=1e-12)
    assert visible_p_value(m, v, surface) > SIGNIFICANCE


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
def test_a_wrong_density_is_detected(distribution):
    # the test above has teeth: widths 3 % off must fail it
    v, rng = direction(1.0), np.random.default_rng(1)
    m = sample(np.broadcast_to(v, (DRAWS["random"], 3)), Surface(0.515, 0.515, distribution), rng)
    assert visible_p_value(m, v, Surface(0.5, 0.5, distribution)) < SIGNIFICANCE


@pytest.mark.parametrize("a", [1e6, 5.0, 1.0, 0.3, 0.0, -0.3, -1.0, -10.0, -50.0])
def test_beckmann_slope_inverts_its_distribution(a):
    u = np.array([1e-12, 1e-3, 0.2, 0.5, 0.8, 0.999, 1.0 - 1e-9])
    x = slope_along(np.full(u.shape, a), u)
    assert np.all(x <= a)
    assert np.all(np.diff(x) > 0.0)
    # for a = -50 the slope's own rounding, 1e-16 of 50, moves the distribution by 1e-12
    np.testing.assert_allclose(slope_distribution(a, x), u, rtol=1e-11)
