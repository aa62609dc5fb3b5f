# SPDX-License-Identifier: GPL-3.0-or-later
"""The tracer on planes and grooves, on which every path is known.

A groove has two planes of slope tan(beta). Reflected on one plane and then the other, a direction
across the groove turns by a multiple of its opening angle, so the bounces can be counted by hand.
"""

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric
from osl.oracle.height_field import HeightField
from osl.oracle.ray_tracer import Tracer
from osl.oracle.simulation import simulate
from osl.oracle.vectors import direction

RAYS = 20_000


def plane():
    return Tracer(HeightField(np.full((8, 8), 3.0), (1.0, 0.5)))


def grooves(beta, cells=8):
    """Two grooves along y, 8 wide, with sides ``beta`` steep; their depth is 4 tan(beta)."""
    across = np.abs(np.arange(16) % 8 - 4) * np.tan(beta)
    return Tracer(HeightField(np.repeat(across[:, None], cells, axis=1), (1.0, 1.0)))


def fresnel(cosine, eta):
    """Reflectance of unpolarised light from its two amplitudes."""
    refracted = np.sqrt(1.0 - (1.0 - cosine**2) / eta**2)
    senkrecht = (cosine - eta * refracted) / (cosine + eta * refracted)
    parallel = (eta * cosine - refracted) / (eta * cosine + refracted)
    return 0.5 * (senkrecht**2 + parallel**2)


@pytest.mark.parametrize("theta", [0.0, 1.0, 1.5, 1.57])
def test_a_plane_is_a_mirror(theta):
    wi = direction(theta, 0.7)
    (hit,) = simulate(plane(), wi, Conductor(), 8, RAYS)
    assert hit.left.all()
    np.testing.assert_array_equal(hit.walk, np.arange(RAYS))
    np.testing.assert_allclose(hit.direction, np.tile(wi * [-1, -1, 1], (RAYS, 1)), atol=1e-15)


@pytest.mark.parametrize(("side", "eta"), [(1.0, 1.5), (-1.0, 1.0 / 1.5)])
@pytest.mark.parametrize("theta", [0.0, 0.6, 1.5])
def test_a_plane_of_glass_follows_snell_and_fresnel(theta, side, eta):
    wi = side * direction(theta, 0.7)
    (hit,) = simulate(plane(), wi, Dielectric(1.5), 8, RAYS)
    assert hit.left.all()
    inside = np.sin(theta) > eta  # total reflection
    reflectance = 1.0 if inside else fresnel(np.cos(theta), eta)
    error = np.sqrt(reflectance * (1.0 - reflectance) / RAYS)
    assert abs((~hit.crossed).mean() - reflectance) <= 4.0 * error
    mirrored = wi * [-1, -1, 1]
    np.testing.assert_array_equal(hit.below_after, hit.crossed ^ (side < 0.0))
    np.testing.assert_allclose(hit.direction[~hit.crossed] - mirrored, 0.0, atol=1e-12)
    if not inside:
        sine = -wi[:2] / eta
        refracted = np.array([*sine, -side * np.sqrt(1.0 - sine @ sine)])
        np.testing.assert_allclose(hit.direction[hit.crossed] - refracted, 0.0, atol=1e-12)


@pytest.mark.parametrize(("degrees", "bounces", "turned"), [(25, 1, 50), (45, 2, 0), (60, 3, 0)])
def test_bounces_in_a_groove_are_those_counted(degrees, bounces, turned):
    # 25: out at once, 50 degrees from z. 45: retroreflected by the two sides. 60: the second
    # bounce is head-on, and the path returns to the first side and out.
    hits = list(simulate(grooves(np.radians(degrees)), direction(0.0), Conductor(), 8, RAYS))
    assert [hit.left.mean() for hit in hits] == [0.0] * (bounces - 1) + [1.0]
    assert not any(hit.lost.any() for hit in hits)
    angle = np.radians(turned)
    across = np.abs(hits[-1].direction[:, 0])
    np.testing.assert_allclose(across, np.sin(angle), atol=1e-12)
    np.testing.assert_allclose(hits[-1].direction[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(hits[-1].direction[:, 2], np.cos(angle), atol=1e-12)


def test_glass_grooves_refract_at_their_sides():
    beta = np.radians(20)
    (hit,) = simulate(grooves(beta), direction(0.0), Dielectric(1.5), 8, RAYS)
    # both parts leave at once: 40 and 20 - asin(sin(20) / 1.5) = 6.8 degrees from the vertical
    assert hit.left.all()
    reflectance = fresnel(np.cos(beta), 1.5)
    error = np.sqrt(reflectance * (1.0 - reflectance) / RAYS)
    assert abs((~hit.crossed).mean() - reflectance) < 4.0 * error
    tilt = np.abs(np.arctan2(hit.direction[:, 0], hit.direction[:, 2]))
    np.testing.assert_allclose(tilt[~hit.crossed], 2.0 * beta, atol=1e-12)
    expected = np.pi - beta + np.arcsin(np.sin(beta) / 1.5)
    np.testing.assert_allclose(tilt[hit.crossed], expected, atol=1e-12)


@pytest.mark.parametrize("theta", [1.0, 1.5])
def test_ridges_shade_what_lies_behind_them(theta):
    # of a side 4 high and 45 degrees steep that faces wi, the ridge before it shades all below
    # 4 (1 - cot) / (1 + cot); the rest is hit evenly
    tracer, wi = grooves(np.pi / 4), direction(theta)
    below = np.zeros(RAYS, bool)
    start = tracer.start(RAYS, False, np.random.default_rng(0))
    there = tracer.follow(start, np.tile(-wi, (RAYS, 1)), below)
    assert not (there.left | there.lost).any()
    np.testing.assert_allclose(there.m - [np.sqrt(0.5), 0.0, np.sqrt(0.5)], 0.0, atol=1e-12)
    cot = 1.0 / np.tan(theta)
    lowest = 4.0 * (1.0 - cot) / (1.0 + cot)
    z = there.point[:, 2]
    assert lowest - 1e-5 < z.min() < lowest + 0.01
    assert 3.99 < z.max() < 4.0 + 1e-5
    error = (4.0 - lowest) / np.sqrt(12.0 * RAYS)
    assert abs(z.mean() - 0.5 * (4.0 + lowest)) < 4.0 * error


@pytest.mark.parametrize("cells", [2, 8, 32])
def test_rays_go_on_from_the_opposite_side(cells):
    # along the grooves, where rays cross up to 4 / cot(theta) = 56 cells before they meet anything,
    # and up to 113 between the two sides
    theta = 1.5
    tracer = grooves(np.pi / 4, cells)
    first, second = simulate(tracer, direction(theta, -np.pi / 2), Conductor(), 8, RAYS)
    assert not (first.left | first.lost).any()
    assert second.left.all()
    expected = [0.0, np.sin(theta), np.cos(theta)]
    np.testing.assert_allclose(second.direction - expected, 0.0, atol=1e-12)


def test_endless_rays_are_lost():
    point = np.array([[0.1, 0.2, 3.0], [0.1, 0.2, 5.0]])
    travel = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    there = grooves(np.pi / 4).follow(point, travel, np.zeros(2, bool))
    np.testing.assert_array_equal(there.lost, [True, False])
    np.testing.assert_array_equal(there.left, [False, True])


@pytest.mark.parametrize("material", [Conductor(), Dielectric(1.5)])
def test_rays_on_the_wrong_side_are_lost(material):
    # started from the wrong side of every facet, rays meet facets from behind or pass the sheet
    tracer = grooves(np.pi / 4)
    tracer._shift = -tracer._shift
    (hit,) = simulate(tracer, direction(0.5), material, 8, RAYS)
    assert hit.lost.all()
    assert hit.dropped == RAYS
    assert not hit.leaving.any()
    assert not hit.staying.any()
