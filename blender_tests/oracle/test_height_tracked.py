# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole walks of the height-tracked model agree with integrals and with a simulation.

The integrals are over heights. The simulation keeps heights, not their distribution function, and
directions in the common frame. Estimates must be within 4 standard errors, with fixed seeds, as in
test_models.py.
"""

import numpy as np
import pytest
from scipy.special import beta, ndtr, ndtri

from osl.oracle import Conductor, Dielectric, Diffuse, Surface, energies
from osl.oracle.ndf import Lambda
from osl.oracle.surface import BECKMANN, GGX, HEIGHT_TRACKED
from osl.oracle.vectors import direction
from osl.oracle.visible import sample

NDFS = [GGX, BECKMANN]


def leaving_at_odd_bounces(big_lambda, step):
    """Energies of bounces 1 and 3 at IOR 1 ``(2,)``, by nested rules of trapezoids.

    Light goes straight on, and changes sides at each vertex. With u the distribution function of
    the height, it gets from u down past u' with the chance (u'/u)^(1 + Lambda). In the material,
    where u counts from below, it leaves with the chance (1 - u)^Lambda, and gets past u' with
    ((1 - u) / (1 - u'))^Lambda. These chances are even from 0 to 1, ``x``, and from the chance to
    leave to 1, ``y``.
    """
    t = np.arange(-3.0, 3.0 + step, step)
    x = 0.5 + 0.5 * np.tanh(0.5 * np.pi * np.sinh(t))  # close to 0 and 1, where powers of x bend
    weight = np.pi * np.cosh(t) * x * (1.0 - x) * step
    fall = x ** (1.0 / (1.0 + big_lambda))

    def leave(u):
        return (1.0 - u) ** big_lambda

    first = leave(fall)  # at the first vertex
    y = first[:, None] + (1.0 - first[:, None]) * x
    second = np.maximum(1.0 - (1.0 - fall[:, None]) * y ** (-1.0 / big_lambda), 0.0)
    third = leave(second[..., None] * fall) @ weight
    return np.array([first @ weight, (1.0 - first) * (third @ weight) @ weight])


@pytest.mark.parametrize("distribution", NDFS)
@pytest.mark.parametrize("theta", [0.8, 1.2, 1.5])
def test_straight_walks_are_integrals_over_heights(distribution, theta):
    surface = Surface(1.0, 1.0, distribution, Dielectric(1.0), HEIGHT_TRACKED)
    wi = direction(theta)
    big_lambda = float(Lambda(wi, surface))
    expected = leaving_at_odd_bounces(big_lambda, 0.1)
    np.testing.assert_allclose(expected, leaving_at_odd_bounces(big_lambda, 0.08), rtol=1e-6)
    closed = (1.0 + big_lambda) * beta(1.0 + big_lambda, 1.0 + big_lambda)  # eq. 15 by heights
    assert expected[0] == pytest.approx(closed, rel=1e-6)
    found = energies(wi, surface, 4, 100_000, 1, roulette=0).transmitted
    error = found.standard_error[::2, 0]
    np.testing.assert_array_less(np.abs(found.mean[::2, 0] - expected), 4.0 * error)
    np.testing.assert_array_equal(found.mean[1::2], 0.0)
    assert np.all(error < 1.5e-3)


def simulated(wi, surface, walks, count, rng):
    """Shares ``(2, count)`` of paths that leave upwards and downwards at bounce 1, 2, ...

    After Heitz et al. 2016: heights h are Gaussian with distribution function C(h), and a path
    from h along d survives up or down to h' with the chance (C(h) / C(h'))^Lambda(d), Lambda
    being negative downwards. A path inside the material is one above a surface upside down: h and
    d change signs. Light leaves or stays by chance. Facets and what they do are the oracle's.
    """
    side = np.ones(walks)  # 1 above the surface, -1 below it
    h, d = np.full(walks, np.inf), np.broadcast_to(-wi, (walks, 3))
    shares = np.zeros((2, count))
    for k in range(count + 1):
        along = side[:, None] * d
        with np.errstate(divide="ignore", over="ignore"):  # infinity: past all heights
            reached = ndtr(side * h) * rng.random(side.size) ** (-1.0 / Lambda(along, surface))
        inside = reached < 1.0
        if k > 0:
            leaving = side[~inside]
            shares[:, k - 1] = (leaving > 0.0).sum() / walks, (leaving < 0.0).sum() / walks
        side, along = side[inside], along[inside]
        h = side * ndtri(reached[inside])
        m = sample(-along, surface, rng)
        o, crossed, _ = surface.material.scatter(-along, m, side < 0.0, rng)
        side = np.where(crossed, -side, side)
        d = side[:, None] * o
    return shares


CASES = [
    (1.0, 1.0, GGX, Dielectric(1.5), 1.5),
    (1.0, 1.0, GGX, Dielectric(1.5), 0.8),
    (1.0, 0.1, GGX, Dielectric(2.4), 1.3),
    (1.0, 1.0, BECKMANN, Dielectric(1.0 / 1.5), 1.2),
    (1.0, 1.0, GGX, Conductor(), 1.2),
    (0.5, 0.5, BECKMANN, Diffuse(), 1.4),
]


@pytest.mark.parametrize(("alpha_x", "alpha_y", "distribution", "material", "theta"), CASES)
def test_energies_agree_with_a_simulation_of_heights(
    alpha_x, alpha_y, distribution, material, theta
):
    surface = Surface(alpha_x, alpha_y, distribution, material, HEIGHT_TRACKED)
    wi, walks, count = direction(theta, 0.4), 100_000, 4
    shares = simulated(wi, surface, walks, count, np.random.default_rng(2))
    found = energies(wi, surface, count, walks, 3, roulette=0)
    for share, energy in zip(shares, (found.reflected, found.transmitted), strict=True):
        error = np.sqrt(share * (1.0 - share) / walks + energy.variance[:, 0])
        # one path where none is expected
        assert np.all(np.abs(energy.mean[:, 0] - share) < 4.0 * error + 1.0 / walks)
    assert np.all(found.both.mean[1, 0] > 0.05)
