# SPDX-License-Identifier: GPL-3.0-or-later
"""Energies of the three models, each for conductor, dielectric and diffuse facets.

Estimates must be within 4 standard errors, unless a test says otherwise. Seeds are fixed, so a pass
stays a pass. A right walk would fail one comparison in 16 000.
"""

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, Surface, energies, evaluate
from osl.oracle.masking import exit_odds
from osl.oracle.ndf import sigma
from osl.oracle.surface import BECKMANN, CORRELATED, GGX, HEIGHT_TRACKED, MODELS
from osl.oracle.vectors import direction

NDFS = [GGX, BECKMANN]
ALPHAS = [(0.1, 0.1), (0.25, 0.25), (0.5, 0.5), (1.0, 1.0), (1.0, 0.1)]
DIRECTIONS = direction(np.array([0.0, 0.8, 1.5]), 0.4)
LOSSLESS = [Conductor(), Diffuse(), Dielectric(1.1), Dielectric(1.5), Dielectric(2.4)]
# and the side that light comes from
ARRIVALS = [(one, side) for one in LOSSLESS for side in ((1, -1) if one.transmits else (1,))]


def name(value):
    if isinstance(value, Conductor | Diffuse):
        return type(value).__name__
    if isinstance(value, Dielectric):
        return f"Dielectric-{value.ior:g}"
    if isinstance(value, int):
        return "above" if value > 0 else "below"
    return str(value)


every_model = pytest.mark.parametrize("model", MODELS)
every_ndf = pytest.mark.parametrize("distribution", NDFS)
every_arrival = pytest.mark.parametrize(("material", "side"), ARRIVALS, ids=name)


@every_model
@every_ndf
@every_arrival
def test_walks_lose_nothing(material, side, distribution, model):
    """Each walk splits its weight into a part that leaves and one that stays.

    So the sum is exact, whatever the parts are. test_values.py tests the parts.
    """
    for alpha in ALPHAS:
        surface = Surface(*alpha, distribution, material, model)
        found = energies(side * DIRECTIONS, surface, 64, 300, 1, roulette=0)
        np.testing.assert_allclose(found.both.total + found.both.remaining, 1.0, rtol=1e-10)
        assert found.both.remaining.max() < 1e-5
        if material.transmits:
            sides = found.reflected.mean + found.transmitted.mean
            np.testing.assert_allclose(sides, found.both.mean, atol=1e-14)
        else:
            np.testing.assert_array_equal(found.transmitted.mean, 0.0)


@pytest.mark.nightly
@every_model
@every_ndf
@every_arrival
def test_thinned_walks_lose_nothing_on_average(material, side, distribution, model):
    # only wide surfaces keep enough walks for the number of survivors to be normal
    surface = Surface(1.0, 1.0, distribution, material, model)
    found = energies(side * DIRECTIONS, surface, 64, 10_000, 2).both
    error = np.sqrt(found.total_variance)
    np.testing.assert_array_less(np.abs(found.total - 1.0), 4.0 * error)
    assert np.all(error < 2e-3)


@pytest.mark.nightly
@every_ndf
@every_arrival
def test_first_bounce_of_correlated_and_height_tracked_models_is_the_same(
    material, side, distribution
):
    # the mean of the height-tracked chance over heights is the correlated one (eq. 15)
    for alpha in ALPHAS:
        correlated, tracked = (
            energies(side * DIRECTIONS, Surface(*alpha, distribution, material, one), 1, 20_000, 3)
            for one in (CORRELATED, HEIGHT_TRACKED)
        )
        for one, other in zip(vars(correlated).values(), vars(tracked).values(), strict=True):
            error = np.sqrt(one.variance + other.variance)
            # 1e-12 where all light or none goes to a side
            np.testing.assert_array_less(np.abs(one.mean - other.mean), 4.0 * error + 1e-12)
        assert np.all(correlated.both.standard_error < 5e-3)


def table(distribution, alpha, theta, rounding, **rows):
    """Cases of an earlier program's table: energy at bounce 1, 2, ... of several models."""
    return [(distribution, alpha, theta, model, row, rounding) for model, row in rows.items()]


CHECKPOINTS = [
    *table(
        GGX, 1.0, 0.0, 5e-4,
        UNCORRELATED=[0.310, 0.358, 0.213, 0.085, 0.026],
        HEIGHT_TRACKED=[0.306, 0.323, 0.212, 0.102, 0.040],
    ),
    *table(
        GGX, 0.5, 1.5, 5e-4,
        UNCORRELATED=[0.784, 0.191, 0.023, 0.002, 0.000],
        HEIGHT_TRACKED=[0.888, 0.104, 0.007, 0.000, 0.000],
    ),
    *table(BECKMANN, 1.0, 0.0, 5e-4, HEIGHT_TRACKED=[0.463, 0.455, 0.077, 0.005, 0.000]),
    *table(BECKMANN, 0.5, 1.0, 5e-4, HEIGHT_TRACKED=[0.867, 0.125, 0.008, 0.000, 0.000]),
]  # fmt: skip
TRANSMITTED = table(
    GGX, 0.5, 1.0, 5e-4,
    CORRELATED=[0.846, 0.072, 0.026, 0.007],
    HEIGHT_TRACKED=[0.848, 0.088, 0.014, 0.004],
)  # fmt: skip


def check_against_table(found, row, rounding):
    """That program gives no error, so it is that of 1e5 paths that each leave at one bounce.

    test_walk.py does the same for the correlated conductor.
    """
    row = np.array(row)
    error = np.sqrt(found.variance[: row.size, 0] + row * (1.0 - row) / 1e5)
    assert np.all(np.abs(found.mean[: row.size, 0] - row) < 4.0 * error + rounding)


@pytest.mark.parametrize(
    ("distribution", "alpha", "theta", "model", "row", "rounding"), CHECKPOINTS
)
def test_conductors_agree_with_an_earlier_program(distribution, alpha, theta, model, row, rounding):
    surface = Surface(alpha, alpha, distribution, model=model)
    check_against_table(energies(direction(theta), surface, 16, 60_000, 5).both, row, rounding)


@pytest.mark.parametrize(
    ("distribution", "alpha", "theta", "model", "row", "rounding"), TRANSMITTED
)
def test_dielectrics_agree_with_an_earlier_program(
    distribution, alpha, theta, model, row, rounding
):
    surface = Surface(alpha, alpha, distribution, Dielectric(1.5), model)
    found = energies(direction(theta), surface, 16, 60_000, 5)
    check_against_table(found.transmitted, row, rounding)


@every_model
def test_first_energy_of_ggx_1_in_closed_form(model):
    # as in test_walk.py; nothing is masked straight up, so all three models have 1 - ln 2
    found = energies(direction(0.0), Surface(1.0, 1.0, model=model), 1, 100_000, 6).both
    assert abs(found.mean[0, 0] - (1.0 - np.log(2.0))) < 4.0 * found.standard_error[0, 0]
    assert found.standard_error[0, 0] < 1.5e-3


@pytest.mark.nightly
@every_model
@every_ndf
@pytest.mark.parametrize("material", LOSSLESS, ids=name)
def test_truncation_cuts_off_and_changes_nothing_else(material, distribution, model):
    surface = Surface(1.0, 1.0, distribution, material, model)
    whole = energies(direction(1.0), surface, 32, 4000, 7, roulette=0).both
    left = 1.0 - np.cumsum(whole.mean[:, 0])
    assert np.all(np.diff(left) <= 1e-14)  # rounding, once all has left
    for count in (1, 2, 5):
        part = energies(direction(1.0), surface, count, 4000, 7, roulette=0).both
        np.testing.assert_array_equal(part.mean, whole.mean[:count])
        np.testing.assert_allclose(part.remaining[0], left[count - 1], atol=1e-12)


@every_model
@pytest.mark.parametrize("ior", [1.1, 1.5, 2.4])
def test_from_below_a_dielectric_is_its_inverse(ior, model):
    below = energies(-DIRECTIONS, Surface(0.5, 0.3, GGX, Dielectric(ior), model), 16, 3000, 10)
    above = energies(DIRECTIONS, Surface(0.5, 0.3, GGX, Dielectric(1.0 / ior), model), 16, 3000, 10)
    # the same walks, but for the rounding of 1 / (1 / ior)
    for one, other in zip(vars(below).values(), vars(above).values(), strict=True):
        np.testing.assert_allclose(one.mean, other.mean, atol=1e-10)


@every_model
def test_an_index_of_1_lets_all_light_through(model):
    surface = Surface(0.5, 0.5, GGX, Dielectric(1.0), model)
    for wi in (DIRECTIONS, -DIRECTIONS):
        found = energies(wi, surface, 64, 1000, 11, roulette=0)
        np.testing.assert_array_equal(found.reflected.mean, 0.0)
        total = found.transmitted.total + found.both.remaining
        np.testing.assert_allclose(total, 1.0, rtol=1e-12)
        if model != HEIGHT_TRACKED:
            # Light goes straight on, and leaves at every other facet with the same chance p. That
            # is slow at a grazing angle: of the correlated model 42 % stay for 64 bounces here.
            v, crossed = DIRECTIONS, np.full(3, True)
            areas = sigma(v, surface), sigma(-v, surface)
            p = exit_odds(v, areas[0], v, areas[1], crossed, None, model).p_exit
            series = p * (1.0 - p) ** np.arange(32)[:, None]
            leaving = found.transmitted.mean[::2, :, 0]
            np.testing.assert_allclose(leaving, series, rtol=1e-9, atol=1e-15)
    with pytest.raises(ValueError, match="ior is 1, where all light goes straight on"):
        evaluate(DIRECTIONS[1], -DIRECTIONS[1], surface)


EXTREME = [(1e-4, 1e-4), (1e-4, 1.0), (1.0, 1.0)]


@pytest.mark.nightly
@every_model
@every_ndf
@pytest.mark.parametrize(
    "material", [Conductor(), Diffuse(), *map(Dielectric, (0.2, 1.0001, 5.0))], ids=name
)
def test_extreme_inputs_stay_finite(material, distribution, model):
    wi = direction(np.array([0.0, 0.8, 1.5, np.pi / 2 - 1e-7]), 0.9)
    wo = direction(np.array([0.0, 0.8, 1.57, np.pi / 2 - 1e-7]), 0.9 + np.pi)
    for alpha in EXTREME:
        surface = Surface(*alpha, distribution, material, model)
        for side in (1.0, -1.0) if material.transmits else (1.0,):
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                found = energies(side * wi, surface, 16, 500, 1, roulette=0).both
                values = [evaluate(side * wi[:, None], wo, surface, 16, 50, 1)]
                if material.transmits:
                    values.append(evaluate(side * wi[:, None], -wo, surface, 16, 50, 1))
            np.testing.assert_allclose(found.total + found.remaining, 1.0, rtol=1e-10)
            for one in (found, *values):
                assert np.all(np.isfinite(one.mean))
                assert np.all(one.mean >= 0.0)
                assert np.all(np.isfinite(one.variance))
