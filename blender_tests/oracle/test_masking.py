# SPDX-License-Identifier: GPL-3.0-or-later
"""Masking and shadowing against their integrals over micronormals and over heights (eqs. 3-17)."""

import numpy as np
import pytest

from osl.oracle.chi_square import sidak, uniform_p_value
from osl.oracle.masking import (
    G1,
    G2,
    G2_middle,
    exit_odds,
    exit_probability,
    first_height,
    height_from_below,
    next_height,
)
from osl.oracle.ndf import Lambda, sigma
from osl.oracle.quadrature import heights, projected_area
from osl.oracle.surface import (
    BECKMANN,
    CORRELATED,
    GGX,
    HEIGHT_TRACKED,
    MODELS,
    UNCORRELATED,
    Surface,
)
from osl.oracle.vectors import direction, normalize, vector

ALPHAS = [(0.1, 0.1), (0.25, 0.25), (0.5, 0.5), (1.0, 1.0), (1.0, 0.1)]
SURFACES = [Surface(x, y, ndf) for ndf in (GGX, BECKMANN) for x, y in ALPHAS]
AZIMUTHS = [0.0, 1.0]
# 0 to pi, and 1e-3 and 1e-6 on both sides of the horizon, where G1 is 0/0 only at pi/2 itself.
ANGLES = np.sort(
    np.concatenate(
        [np.linspace(0.0, np.pi, 16), np.pi / 2 + np.array([-1e-3, -1e-6, 1e-6, 1e-3])],
    )
)
# The rule over micronormals is good to 4e-14 with 80 x 80 points in each of its parts.
RELATIVE = 1e-12
# The rule over heights is good to 3e-13.
OVER_HEIGHTS = 2e-12
# a B(a, 1 + Lambda) is made of logarithms and an integral: good to 6e-9 up to a = 1e6.
CROSSED = 2e-8
UP = direction(0.0)


def name(surface):
    return f"{surface.distribution}-{surface.alpha_x}-{surface.alpha_y}"


@pytest.mark.parametrize("phi", AZIMUTHS, ids="phi={:.2f}".format)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_g1_on_the_whole_sphere_is_its_integral(surface, phi):
    compared = 0
    for theta in ANGLES:
        w = direction(theta, phi)
        area = projected_area(w, surface)
        if area < 1e-30:  # nearly straight down no facet is in sight, for the formula as well
            assert float(sigma(w, surface)) < 1e-30
            continue
        compared += 1
        assert float(G1(w, surface)) == pytest.approx(abs(w[2]) / area, rel=RELATIVE)  # eq. 4
        # eq. 3; 1 + Lambda(w) is -Lambda(-w) below the horizon, where the sum would cancel
        one_plus = 1.0 + Lambda(w, surface) if w[2] > 0.0 else -Lambda(-w, surface)
        assert float(G1(w, surface)) == pytest.approx(abs(1.0 / one_plus), rel=RELATIVE)
    assert compared >= 11  # all above the horizon, and at least three below it


@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_g1_exceeds_1_only_below_the_horizon(surface):
    above = G1(direction(ANGLES[np.pi / 2 > ANGLES], 0.7), surface)
    assert np.all((above > 0.0) & (above <= 1.0))
    assert np.all(np.diff(above) <= 0.0)
    # far enough down G1 grows beyond every limit
    assert G1(direction(2.0, 0.0), Surface(0.25, 0.25)) > 1.0


PAIRS = [(0.0, 0.0), (0.3, 1.2), (1.2, 0.3), (1.55, 1.0), (1.0, 1.57), (1.5, 1.5)]


def pair_id(pair):
    return f"{pair[0]}-{pair[1]}"


@pytest.mark.parametrize("pair", PAIRS, ids=pair_id)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_g2_is_its_integral_over_micronormals(surface, pair):
    wi, wo = direction(pair[0], 0.4), direction(pair[1], 2.6)
    ci, co = wi[2], wo[2]
    away = projected_area(-wo, surface)
    # eqs. 6-7: both directions above the surface
    integral = projected_area(wi, surface) * co + away * ci
    g2 = float(G2(wi, wo, surface))
    assert g2 == pytest.approx(ci * co / integral, rel=RELATIVE)
    both = 1.0 + Lambda(wi, surface) + Lambda(wo, surface)
    assert g2 == pytest.approx(1.0 / both, rel=1e-12)  # eq. 5
    assert g2 == pytest.approx(float(G2(wo, wi, surface)), rel=1e-12)
    # eqs. 8-11: -wi below it. (Where no facet is in sight of either, both sides are 1/0.)
    integral = projected_area(-wi, surface) * co + away * ci
    if integral > 1e-30:
        g2 = float(G2(-wi, wo, surface))
        assert g2 == pytest.approx(ci * co / integral, rel=RELATIVE)
        assert g2 == pytest.approx(1.0 / (Lambda(wi, surface) + Lambda(wo, surface)), rel=1e-12)


# Polar angles of v in the frame that widens the surface to alpha = 1, so that all have the same a,
# and of o. Below the horizon a runs from 6e5 to 4e-4.
VERTICES = [
    (0.3, 0.9),
    (1.5, 0.2),
    (1.57, 1.57),
    (1.570797, 1.0),
    (1.6, 0.9),
    (2.0, 1.4),
    (2.7, 1.57),
]


@pytest.mark.parametrize("pair", VERTICES, ids=pair_id)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_first_and_middle_bounce_are_integrals_over_heights(surface, pair):
    # eq. 15 with u the distribution function of h: G1(o, h) = u^Lambda(o), and G1(v, h) = u^(a-1)
    # with a = |1 + Lambda(v)|, which is u^Lambda(v) above the horizon and whose mean is eq. 3
    widths = np.array([surface.alpha_x, surface.alpha_y, 1.0])
    v, o = normalize(direction(pair[0], 0.4) / widths), direction(pair[1], 2.6)
    log_u, log_rest, log_weight = heights()
    a, big_lambda = float(sigma(v, surface) / abs(v[2])), float(Lambda(o, surface))
    arriving = np.exp((a - 1.0) * log_u + log_weight)  # G1(v, h) P1(h) dh
    leaving, blocked = np.exp(big_lambda * log_u), -np.expm1(big_lambda * log_u)
    g1, g2 = float(G1(v, surface)), float(G2(v, o, surface))
    middle = float(G2_middle(v, o, surface))
    assert g1 == pytest.approx(arriving.sum(), rel=OVER_HEIGHTS)
    assert g2 == pytest.approx((arriving * leaving).sum(), rel=OVER_HEIGHTS)
    assert middle == pytest.approx((arriving * blocked).sum(), rel=OVER_HEIGHTS)  # eq. 16
    assert g2 + middle == pytest.approx(g1, rel=1e-14)
    assert float(exit_probability(v, o, surface)) == pytest.approx(g2 / g1, rel=1e-14)
    # eqs. 14 and 17: towards o below the horizon all that arrive stay
    assert float(G2_middle(v, -o, surface)) == g1
    assert float(G2(v, -o, surface)) == 0.0

    # the same mean, of the chance that the height-tracked model has at each height, is the
    # correlated model's, for paths that cross the surface as well
    area_v, area_back = sigma(v, surface), sigma(-o, surface)
    for crossed, log_height in ((False, log_u), (True, log_rest)):
        tracked = exit_odds(v, area_v, o, area_back, crossed, log_height, HEIGHT_TRACKED)
        mean = [(a * arriving * chance).sum() for chance in tracked]
        correlated = exit_odds(v, area_v, o, area_back, np.array(crossed), None, CORRELATED)
        np.testing.assert_allclose(correlated, mean, rtol=CROSSED if crossed else OVER_HEIGHTS)


EXTREMES = [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.0099, 0.0101, 0.3, 1.0, 7.0, 1e2, 1e4, 1e6]


@pytest.mark.parametrize("big_lambda", EXTREMES, ids="Lambda={:g}".format)
@pytest.mark.parametrize("crossed", [False, True], ids=["reflected", "crossed"])
def test_correlated_odds_keep_their_digits(crossed, big_lambda):
    # a B(a, 1 + Lambda), and a / (a + Lambda), as integrals over heights; v and o straight up make
    # a and Lambda equal to the areas
    log_u, log_rest, log_weight = heights()
    towards = log_rest if crossed else log_u
    for a in (1e-3, 1e-2, 0.3, 1.0, 2.5, 1e2, 1e4, 1e6):
        weight = a * np.exp((a - 1.0) * log_u + log_weight)
        p_exit, p_stay = exit_odds(
            UP, np.array(a), UP, np.array(big_lambda), np.array(crossed), None, CORRELATED
        )
        digits = CROSSED if crossed else OVER_HEIGHTS
        expected = (weight * np.exp(big_lambda * towards)).sum()
        assert float(p_exit) == pytest.approx(expected, rel=digits, abs=1e-290)
        expected = (weight * -np.expm1(big_lambda * towards)).sum()
        assert float(p_stay) == pytest.approx(expected, rel=digits)
        assert float(p_exit + p_stay) == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_uncorrelated_odds_are_g1(surface):
    # eqs. 19-24: p_exit = G1(o) and 1 - p_exit = Lambda(o) / (1 + Lambda(o)), whatever v
    o = direction(np.array([0.0, 0.4, 1.2, 1.57]), 2.6)
    odds = exit_odds(UP, sigma(UP, surface), o, sigma(-o, surface), None, None, UNCORRELATED)
    np.testing.assert_allclose(odds.p_exit, G1(o, surface), rtol=1e-14)
    big_lambda = Lambda(o, surface)
    np.testing.assert_allclose(odds.p_stay, big_lambda / (1.0 + big_lambda), rtol=1e-14)


@pytest.mark.parametrize("model", MODELS)
def test_paths_below_the_horizon_stay(model):
    surface, o = Surface(0.5, 0.5), direction(np.array([1.6, 2.0, 3.0]))
    for crossed in (False, True):
        odds = exit_odds(
            UP,
            sigma(UP, surface),
            o,
            sigma(-o, surface),
            np.full(3, crossed),
            np.full(3, -1.0),
            model,
        )
        np.testing.assert_array_equal(odds.p_exit, 0.0)  # eq. 14
        np.testing.assert_array_equal(odds.p_stay, 1.0)


# Walks at heights u that turn to a direction with this |Lambda|, upwards or downwards.
STEPS = [
    (up, u, big_lambda)
    for up in (True, False)
    for u in (1.0 - 1e-12, 0.9, 0.2, 1e-6)
    for big_lambda in (1e-3, 0.3, 1.0, 20.0)
]
# between u = 1 - 1e-12 and 1 there are too few doubles to bin upward steps
BINNED = [(up, u, big_lambda) for up, u, big_lambda in STEPS if not (up and u > 0.99)]
ENTRIES = [(distribution, theta) for distribution in (GGX, BECKMANN) for theta in (0.0, 1.0, 1.55)]
SIGNIFICANCE = sidak(len(BINNED) + len(ENTRIES))
DRAWS = 40_000


@pytest.mark.parametrize(("up", "u", "big_lambda"), STEPS)
def test_next_heights_follow_their_distribution(up, u, big_lambda):
    # a path from height u survives down to u' with chance (u'/u)^|Lambda|, up to u' with
    # (u/u')^Lambda, of which u^Lambda escape and are left out here
    o = np.broadcast_to(direction(0.0 if up else np.pi), (DRAWS, 3))
    log_u = np.full(DRAWS, np.log(u))
    met = next_height(log_u, o, np.full(DRAWS, big_lambda), np.random.default_rng(7))
    assert np.all(met <= 0.0)
    if up:
        assert np.all(met >= log_u)
        distribution = np.expm1(big_lambda * (log_u - met)) / np.expm1(big_lambda * log_u)
    else:
        assert np.all(met <= log_u)
        distribution = np.exp(big_lambda * (met - log_u))
    if (up, u, big_lambda) in BINNED:
        assert uniform_p_value(distribution) > SIGNIFICANCE


@pytest.mark.parametrize(("distribution", "theta"), ENTRIES)
def test_first_heights_follow_their_distribution(distribution, theta):
    surface = Surface(0.5, 0.5, distribution)
    v = np.broadcast_to(direction(theta), (DRAWS, 3))
    met = first_height(v, sigma(v, surface), np.random.default_rng(8))
    assert np.all(met <= 0.0)
    u = np.exp((1.0 + Lambda(v[0], surface)) * met)  # u^a has density 1
    assert uniform_p_value(u) > SIGNIFICANCE


def test_a_wrong_height_is_detected():
    # 5 % more of 1 + Lambda fails the test
    surface, v = Surface(0.5, 0.5), np.broadcast_to(direction(1.0), (DRAWS, 3))
    met = first_height(v, 1.05 * sigma(v, surface), np.random.default_rng(8))
    assert uniform_p_value(np.exp((1.0 + Lambda(v[0], surface)) * met)) < SIGNIFICANCE


def test_heights_from_below_are_complements():
    u = np.array([1e-300, 1e-9, 0.3, 0.5, 1.0 - 1e-9])
    # 1 - u from the logarithm of u: half an ulp of it near u = 1 - 1e-9 is 5e-8 of the difference
    np.testing.assert_allclose(height_from_below(np.log(u)), np.log1p(-u), rtol=1e-7)
    exact = np.array([0.3, 1e-4])
    np.testing.assert_allclose(height_from_below(np.log1p(-exact)), np.log(exact), rtol=1e-12)
    assert np.isfinite(height_from_below(np.zeros(1)))  # the very top, from where there is no way


def test_heights_stay_legal_at_the_extremes():
    # straight up or down, horizontal, and from the top or the bottom of the surface
    z = np.array([1.0, 1e-17, 0.0, -1e-17, -1.0])
    o = vector(np.sqrt(1.0 - z * z), 0.0 * z, z)
    for area in (0.0, 1e-300, 0.5):
        for log_u in (0.0, -1e-16, -700.0):
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                met = next_height(np.full(5, log_u), o, np.full(5, area), np.random.default_rng(9))
            assert np.all(np.isfinite(met))
            assert np.all(met <= 0.0)
