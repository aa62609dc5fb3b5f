# SPDX-License-Identifier: GPL-3.0-or-later
"""Light on random height fields: conservation, consistency, and Smith's theory where it is exact.

Where theory and a Gaussian surface may differ nothing is asserted here; docs/figures has numbers.
"""

from functools import cache

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, Surface, energies
from osl.oracle.height_field import HeightField
from osl.oracle.ray_tracer import Tracer
from osl.oracle.simulation import simulate, simulated_energies
from osl.oracle.surface import BECKMANN
from osl.oracle.vectors import direction, dot

LEAKS = 1e-4  # share of rays that may be lost
ALPHAS = [(0.25, 0.25), (1.0, 1.0), (1.0, 0.1)]
MATERIALS = [Conductor(), Diffuse(), Dielectric(1.5)]


@cache
def field(alpha, seed=0):
    """32 correlation lengths a side."""
    return HeightField.gaussian(Surface(*alpha, BECKMANN), 256, 8, seed)


@cache
def tracer(alpha, seed=0):
    return Tracer(field(alpha, seed))


@pytest.mark.parametrize("material", MATERIALS, ids=str)
@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("theta", [0.0, 1.0, 1.5])
def test_lossless_materials_lose_nothing_but_leaks(material, alpha, theta):
    rays, leaving = 30_000, 0.0
    for hit in simulate(tracer(alpha), direction(theta, 0.3), material, 64, rays, 5):
        leaving += hit.leaving.sum()
    assert hit.dropped <= LEAKS * rays
    assert leaving + hit.staying.sum() + hit.dropped == pytest.approx(rays, rel=1e-12)
    assert hit.staying.sum() <= 1e-4 * rays  # what bounces more than 64 times


@pytest.mark.parametrize("theta", [0.5, 2.5])
def test_bounces_are_linked(theta):
    # each ray is reflected or refracted at a facet that faces it, and goes on from where it was
    wi = direction(theta, 1.0)
    material, rays = Dielectric(1.5), 20_000
    alive = np.arange(rays)
    v, below = np.broadcast_to(-wi if theta > 1.6 else wi, (rays, 3)), np.full(rays, theta > 1.6)
    for hit in simulate(tracer((1.0, 0.1)), wi, material, 64, rays, 1):
        np.testing.assert_array_equal(hit.walk, alive)
        np.testing.assert_array_equal(hit.v, v)
        np.testing.assert_array_equal(hit.below, below)
        assert np.all(hit.m[:, 2] > 0.0)
        assert np.all(dot(hit.v, hit.m) > 0.0)
        assert np.all(dot(hit.o, hit.m) > 0.0)
        travel = np.where(hit.below[:, None], hit.v, -hit.v)
        # reflection keeps what is along the facet, refraction scales it by the indices
        along_before = travel - dot(travel, hit.m)[:, None] * hit.m
        along_after = hit.direction - dot(hit.direction, hit.m)[:, None] * hit.m
        ratio = np.where(hit.crossed, np.where(hit.below, 1.5, 1.0 / 1.5), 1.0)
        np.testing.assert_allclose(along_after, ratio[:, None] * along_before, atol=1e-12)
        np.testing.assert_array_equal(hit.direction[hit.left, 2] < 0.0, hit.below_after[hit.left])
        on = ~(hit.left | hit.lost)
        alive, v, below = hit.walk[on], -hit.o[on], hit.below_after[on]


def test_colours_are_multiplied_at_each_bounce():
    albedo = (0.8, 0.5, 0.2)
    for k, hit in enumerate(simulate(tracer((1.0, 1.0)), direction(0.5), Diffuse(albedo), 4, 5000)):
        expected = np.where(hit.left[:, None], np.power(albedo, k + 1), 0.0)
        np.testing.assert_allclose(hit.leaving, expected, rtol=1e-12)
    assert k == 3


@pytest.mark.parametrize("alpha", ALPHAS)
def test_first_hits_from_above_are_facets_at_random(alpha):
    # from z all facets are visible, each in proportion to its projected area
    (hit,) = simulate(tracer(alpha), direction(0.0), Conductor(), 1, 100_000, 3)
    slopes = -hit.m[:, :2] / hit.m[:, 2:]
    whole = field(alpha).slope_statistics()
    error = np.sqrt(whole.variance / slopes.shape[0])
    assert np.all(np.abs(slopes.mean(axis=0)) < 4.0 * error)
    square = (slopes**2).mean(axis=0)
    error = whole.variance * np.sqrt((whole.kurtosis - 1.0) / slopes.shape[0])
    assert np.all(np.abs(square - whole.variance) < 4.0 * error)


@pytest.mark.nightly
@pytest.mark.parametrize("alpha", ALPHAS)
def test_light_from_below_meets_the_field_upside_down(alpha):
    # turned about by a point reflection, a field of glass is lit from the other side
    wi, rays = direction(1.0, 0.4), 100_000
    turned = Tracer(HeightField(-field(alpha).heights[::-1, ::-1], field(alpha).spacing))
    from_above = shares(tracer(alpha), wi, Dielectric(1.5), rays, 1)
    from_below = shares(turned, -wi, Dielectric(1.0 / 1.5), rays, 2)
    reflected, transmitted = from_above
    assert reflected[0] > 0.03
    assert transmitted[1] > 0.005  # enough of the second bounce to tell
    error = np.sqrt((from_below + from_above) / rays)
    assert np.all(np.abs(from_below - from_above) <= 4.0 * error)


def shares(tracer, wi, material, rays, rng):
    """Shares of rays that are reflected and transmitted at each of three bounces, ``(2, 3)``."""
    counts = np.zeros((2, 3))
    for k, hit in enumerate(simulate(tracer, wi, material, 3, rays, rng)):
        through = hit.below_after ^ (wi[2] < 0.0)
        counts[:, k] = (hit.left & ~through).sum(), (hit.left & through).sum()
    return counts / rays


@pytest.mark.nightly
@pytest.mark.parametrize("theta", [0.0, 0.5])
def test_smith_holds_where_little_is_masked(theta):
    # At alpha 0.25 all but 0.2 % leaves at once. The surface is not Smith's: height and slope of a
    # Gaussian field are correlated over a distance, which Smith leaves out, so this is no z-test.
    surface, wi = Surface(0.25, 0.25, BECKMANN), direction(theta)
    found = simulated_energies(
        [tracer((0.25, 0.25), seed) for seed in range(4)], wi, Conductor(), 8, 50_000
    )
    smith = energies(wi, surface, 8, 50_000)
    assert found.both.standard_error[0, 0] < 2e-4
    assert abs(found.both.mean[0, 0] - smith.both.mean[0, 0]) < 1e-3


def test_energies_are_means_over_fields():
    tracers = [tracer((1.0, 1.0), seed) for seed in range(3)]
    wi = np.stack([direction(0.3), direction(2.0, 0.5)])
    material, rays = Dielectric(1.5), 5000
    found = simulated_energies(iter(tracers), wi, material, 3, rays, 9)
    rng = np.random.default_rng(9)
    # fields, directions, sides, bounces
    each = np.array([[shares(one, w, material, rays, rng) for w in wi] for one in tracers])
    for side, values in enumerate([found.reflected, found.transmitted]):
        assert values.mean.shape == (3, 2, 3)
        for channel in range(3):
            expected = each[:, :, side].mean(axis=0).T
            np.testing.assert_allclose(values.mean[..., channel], expected, rtol=1e-12)
            expected = each[:, :, side].var(axis=0, ddof=1).T / 3
            np.testing.assert_allclose(values.variance[..., channel], expected, rtol=1e-10)
    total = each.sum(axis=(2, 3))
    np.testing.assert_allclose(found.both.total[:, 0], total.mean(axis=0), rtol=1e-12)
    variance = total.var(axis=0, ddof=1) / 3
    np.testing.assert_allclose(found.both.total_variance[:, 0], variance, rtol=1e-10)
    whole = found.both.total + found.both.remaining + found.lost[:, None]
    np.testing.assert_allclose(whole, 1.0, rtol=1e-12)
    assert np.all(found.both.remaining > 0.0)  # of three bounces


def test_the_same_seed_gives_the_same_rays():
    def run(seed):
        return [hit.direction for hit in simulate(tracer((1.0, 1.0)), wi, Diffuse(), 3, 500, seed)]

    wi = direction(1.0)
    for one, other in zip(run(3), run(np.random.default_rng(3)), strict=True):
        np.testing.assert_array_equal(one, other)
    assert not np.array_equal(run(3)[0], run(4)[0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda t: simulate(t, direction(1.6), Conductor()), "not above the surface"),
        (lambda t: simulate(t, np.array([0.0, 0.0, 2.0]), Conductor()), "not a unit vector"),
        (lambda t: simulate(t, np.eye(3)[2:], Conductor()), r"wi has shape \(1, 3\)"),
        (lambda t: simulate(t, direction(1.0), Conductor(), 0), "max_bounces is 0"),
        (lambda t: simulate(t, direction(1.0), Conductor(), 4, 0), "rays is 0"),
        (lambda t: simulated_energies([t], direction(1.0), Conductor()), "tracers has 1"),
        (lambda t: simulated_energies([], direction(1.0), Conductor()), "tracers has 0"),
        (lambda t: simulated_energies([t, t], direction(1.0), Conductor()), "one twice, number 1"),
        (lambda t: simulated_energies([], np.zeros((0, 3)), Conductor()), r"wi has shape \(0, 3\)"),
        (lambda t: simulated_energies([], None, Conductor()), r"wi has shape \(\)"),
        (lambda t: simulated_energies([], direction(2.0), Conductor()), "not above the surface"),
        (lambda t: simulated_energies([], direction(1.0), Conductor(), 4, 0), "rays is 0"),
    ],
)
def test_bad_values_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call(tracer((1.0, 1.0)))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda t: simulate(t, direction(1.0), Conductor(), 4, 100.0), "rays is 100.0"),
        (lambda t: simulate(t, direction(1.0), Conductor(), 4.0), "max_bounces is 4.0"),
        (lambda t: simulate(field((1.0, 1.0)), direction(1.0), Conductor()), "a HeightField; give"),
        (lambda t: simulated_energies(t, direction(1.0), Conductor()), "tracers is a Tracer"),
        (
            lambda t: simulated_energies([field((1.0, 1.0)), t], direction(1.0), Conductor()),
            "tracer is a HeightField; give a Tracer",
        ),
        (lambda t: simulated_energies([], direction(1.0), Conductor(), 4, 1e3), "rays is 1000.0"),
        (lambda t: Tracer(np.zeros((4, 4))), "field is a ndarray; give a HeightField"),
    ],
)
def test_wrong_types_are_named(call, message):
    with pytest.raises(TypeError, match=message):
        call(tracer((1.0, 1.0)))
