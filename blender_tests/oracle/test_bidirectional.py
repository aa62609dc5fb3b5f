# SPDX-License-Identifier: GPL-3.0-or-later
"""The bidirectional estimator against the walk: the same means, and what variance each has."""

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, Surface, bidirectional, evaluate
from osl.oracle.fresnel import dielectric_reflectance
from osl.oracle.masking import exit_odds
from osl.oracle.materials import Scattered
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import gauss_legendre
from osl.oracle.surface import BECKMANN, CORRELATED, GGX, HEIGHT_TRACKED, UNCORRELATED
from osl.oracle.vectors import direction, dot, half_vector, normalize
from osl.oracle.walk import bounces, turn_and_leave

pytestmark = pytest.mark.nightly

WI = direction(1.2)
CASES = [
    (Conductor(), direction(0.6, 2.0)),
    (Conductor(), direction(1.0, 2.6)),
    (Diffuse(), direction(0.6, 2.0)),
    (Diffuse((0.9, 0.5, 0.2)), direction(1.4, 0.5)),
    (Dielectric(1.5), direction(0.5, 2.0)),
    (Dielectric(1.5), direction(2.0, 2.5)),
    (Dielectric(1.0 / 1.5), direction(0.5, 2.0)),
    (Dielectric(1.0 / 1.5), direction(2.3, 2.5)),
]


@pytest.mark.parametrize("model", [CORRELATED, UNCORRELATED])
@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
@pytest.mark.parametrize(("material", "wo"), CASES)
def test_both_estimators_agree(model, distribution, material, wo):
    # alpha this large keeps the peaks broad enough for the walk's own error to be trusted
    surface = Surface(0.8, 0.5, distribution, material, model)
    one = evaluate(WI, wo, surface, 4, 40_000, 1, roulette=0)
    two = bidirectional.evaluate(WI, wo, surface, 4, 10_000, 2)
    if material.smooth:
        np.testing.assert_array_equal(one.mean[0], two.mean[0])
        np.testing.assert_array_equal(two.variance[0], 0.0)
    # 4 standard errors, of all bounces together and of those that are known to 10 %
    total_error = np.sqrt(one.total_variance + two.total_variance)
    assert np.all(np.abs(one.total - two.total) < 4.0 * total_error)
    error = np.sqrt(one.variance + two.variance)
    known = error[1:] < 0.1 * two.mean[1:]
    assert known[0].all() or distribution == BECKMANN
    assert np.all((np.abs(one.mean - two.mean) < 4.0 * error)[1:][known])


@pytest.mark.parametrize("model", [CORRELATED, UNCORRELATED])
@pytest.mark.parametrize("material", [Conductor(), Diffuse()], ids=["conductor", "diffuse"])
def test_bounces_beyond_the_first_vary_less(model, material):
    surface, wo = Surface(0.8, 0.5, GGX, material, model), direction(0.6, 2.0)
    one = evaluate(WI, wo, surface, 5, 20_000, 1, roulette=0)
    two = bidirectional.evaluate(WI, wo, surface, 5, 20_000, 2)
    gain = one.variance[1:, 0] / two.variance[1:, 0]
    # measured 1.6 to 10, rising with the bounce, for these widths and directions; it is less where
    # lobes are broader
    assert np.all(gain > 1.2)


def second_bounce_by_quadrature(wi, wo, surface, count=800):
    """Bounce 2 of mirrors: the integral over all directions d between both vertices."""
    z, weight = gauss_legendre(count, -1.0, 1.0)
    d = direction(np.arccos(z)[:, None], np.pi * (np.arange(2 * count) + 0.5) / count)
    v = np.broadcast_to(wi, d.shape)
    turn = D(half_vector(v, d), surface) / (4.0 * sigma(wi, surface))
    odds = exit_odds(v, sigma(v, surface), d, sigma(-d, surface), None, None, surface.model)
    value = turn * odds.p_stay * turn_and_leave(-d, wo, surface)[..., 0]
    return (value.sum(axis=1) * weight).sum() * np.pi / count


@pytest.mark.parametrize("model", [CORRELATED, UNCORRELATED])
@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
@pytest.mark.parametrize("wo", [direction(1.3, 0.4), direction(0.6, 2.0)], ids=["back", "on"])
def test_second_bounce_by_quadrature(model, distribution, wo):
    # back towards wi, Beckmann, the walk finds half of it: 3.7(1)e-9 of 7.0e-9 with 2e6 walks
    surface = Surface(0.8, 0.5, distribution, model=model)
    found = bidirectional.evaluate(WI, wo, surface, 2, 200_000, 5)
    expected = second_bounce_by_quadrature(WI, wo, surface)
    error = found.standard_error[1, 0]
    assert error < 0.06 * expected
    # the rule itself is good to 1 %, by twice the count
    assert abs(found.mean[1, 0] - expected) < 4.0 * error + 0.01 * expected


def around(axis, angle, count, rng):
    """Directions even over the cone of half-angle ``angle`` about ``axis``."""
    z = 1.0 - rng.random(count) * (1.0 - np.cos(angle))
    phi = 2.0 * np.pi * rng.random(count)
    x = normalize(np.cross([0.0, 1.0, 0.0], axis))
    radius = np.sqrt(1.0 - z * z)
    local = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    return local @ np.stack([x, np.cross(axis, x), axis])


class Dice:
    """In place of a Generator: numbers drawn before."""

    def __init__(self, numbers):
        self.numbers = numbers

    def random(self, size):
        return self.numbers


class EvenDielectric(Dielectric):
    """The same glass, that reflects half of the paths, and gives them weights instead."""

    def scatter(self, v, m, below, rng):
        reflects = rng.random(v.shape[0]) < 0.5
        o, crossed, _ = super().scatter(v, m, below, Dice(np.where(reflects, -1.0, 1.0)))
        reflectance = dielectric_reflectance(np.clip(dot(v, m), 0.0, 1.0), self.eta(below))
        weight = 2.0 * np.where(crossed, 1.0 - reflectance, reflectance)
        return Scattered(o, crossed, weight[:, None])


@pytest.mark.parametrize("model", [CORRELATED, UNCORRELATED])
def test_narrow_peaks_that_the_walk_misses(model):
    """IOR 1.05: light that crosses, is reflected, and crosses back. The walk's connections meet
    its narrow peaks too rarely; counting the walks that leave within a cone settles who is right.
    """
    wo, angle = direction(0.5, 2.0), 0.4
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(angle))
    rng = np.random.default_rng(3)
    batches, walks = 20, 50_000
    surface = Surface(0.3, 0.3, GGX, EvenDielectric(1.05), model)
    counts = np.zeros(batches)
    for i in range(batches):
        *_, third = bounces(np.broadcast_to(WI, (walks, 3)), surface, 3, rng, 0.0)
        inside = (third.direction @ wo > np.cos(angle)) & ~third.below_after
        counts[i] = third.leaving[inside, 0].sum() / walks
    counted, counted_error = counts.mean(), counts.std(ddof=1) / np.sqrt(batches)
    surface = Surface(0.3, 0.3, GGX, Dielectric(1.05), model)
    values = bidirectional.evaluate(WI, around(wo, angle, 4000, rng), surface, 3, 50, 4)
    values = values.mean[2, :, 0] * solid_angle
    error = np.hypot(values.std(ddof=1) / np.sqrt(values.size), counted_error)
    assert error < 0.02 * counted
    assert abs(values.mean() - counted) < 4.0 * error


SETTLED = [
    (CORRELATED, direction(0.55852, -1.67138), direction(2.44708, 0.25966)),
    (UNCORRELATED, direction(0.62286, 1.27786), direction(2.03127, 0.29253)),
]


@pytest.mark.parametrize(("model", "wi", "wo"), SETTLED, ids=["correlated", "uncorrelated"])
def test_pairs_that_the_walk_finds_hard(model, wi, wo):
    """Glass, bounce 2: of a few thousand walks, hardly any connects with a narrow peak, and their
    scatter gives an error that is too small. A million and more settle the value."""
    surface = Surface(0.25, 0.25, GGX, Dielectric(1.5), model)
    one = evaluate(wi, wo, surface, 2, 3_000_000, 1, roulette=0)
    two = bidirectional.evaluate(wi, wo, surface, 2, 40_000, 2)
    one_error, two_error = one.standard_error[1, 0], two.standard_error[1, 0]
    assert one_error < 0.05 * one.mean[1, 0]
    assert two_error < 0.02 * two.mean[1, 0]
    assert abs(one.mean[1, 0] - two.mean[1, 0]) < 4.0 * np.hypot(one_error, two_error)


def test_edges():
    surface, wo = Surface(0.5, 0.5), direction(0.4, 1.0)
    single = bidirectional.evaluate(WI, wo, surface, 1, 2)
    np.testing.assert_array_equal(single.mean, evaluate(WI, wo, surface, 1, 2).mean)
    same = [bidirectional.evaluate(WI, wo, surface, 3, 100, 42).mean for _ in range(2)]
    np.testing.assert_array_equal(*same)
    assert np.all(np.isnan(single.remaining))
    with pytest.raises(ValueError, match="model is 'HEIGHT_TRACKED'"):
        bidirectional.evaluate(WI, wo, Surface(0.5, 0.5, model=HEIGHT_TRACKED))
    with pytest.raises(ValueError, match="ior is 1"):
        bidirectional.evaluate(WI, wo, Surface(0.5, 0.5, material=Dielectric(1.0)))
    with pytest.raises(ValueError, match=r"wo contains .*not above the surface"):
        bidirectional.evaluate(WI, -wo, surface)


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
@pytest.mark.parametrize("alpha", [(1e-3, 1e-3), (1.0, 1e-3), (1.0, 1.0)])
@pytest.mark.parametrize("material", [Conductor(), Diffuse(), Dielectric(1.5), Dielectric(0.2)])
def test_extreme_inputs_stay_finite(distribution, alpha, material):
    surface = Surface(*alpha, distribution, material)
    ends = direction(np.array([0.0, 0.8, np.pi / 2 - 1e-7]), 0.4)
    wo = np.concatenate([ends, -ends]) if material.transmits else ends
    found = bidirectional.evaluate(ends[:, None], wo, surface, 4, 50, 1)
    assert np.all(np.isfinite(found.mean))
    assert np.all(found.mean >= 0.0)
