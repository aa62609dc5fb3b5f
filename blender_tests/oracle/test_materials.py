# SPDX-License-Identifier: GPL-3.0-or-later
"""Facets of metal, glass and matte: Snell's law, the vertex terms and their sums."""

from functools import partial

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, F82Tint, IndexOfRefraction, Surface, evaluate
from osl.oracle.fresnel import dielectric_reflectance
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import Zone, basis, facet_zones, visible_normals
from osl.oracle.surface import BECKMANN
from osl.oracle.vectors import direction, dot, normalize

IORS = [1.1, 1.5, 2.4, 1.0 / 1.5]
SURFACES = [Surface(0.5, 0.5), Surface(1.0, 0.3), Surface(0.5, 0.5, BECKMANN)]
SIDES = [False, True]
# What the rule of 80 x 160 points reaches: measured 4e-14.
QUADRATURE = 1e-12


def name(surface):
    return f"{surface.distribution}-{surface.alpha_x}-{surface.alpha_y}"


def side_id(below):
    return "below" if below else "above"


def ior_id(ior):
    return f"ior={ior:.3g}"


def critical_cosine(eta):
    return np.sqrt(max(1.0 - eta * eta, 0.0))


def vertices(surface, below, count=4000, seed=3):
    """Directions ``v`` all around and facets ``m`` that they see."""
    rng = np.random.default_rng(seed)
    v = normalize(rng.standard_normal((count, 3)))
    m = normalize(rng.standard_normal((count, 3)) * [surface.alpha_x, surface.alpha_y, 1.0])
    m *= np.sign(m[:, 2:])
    seen = dot(v, m) > 0.0
    return v[seen], m[seen], np.full(seen.sum(), below), rng


@pytest.mark.parametrize("ior", IORS, ids=ior_id)
@pytest.mark.parametrize("below", SIDES, ids=side_id)
def test_refraction_follows_snells_law(below, ior):
    v, m, side, rng = vertices(SURFACES[0], below)
    o, crossed, weight = Dielectric(ior).scatter(v, m, side, rng)
    eta = 1.0 / ior if below else ior
    np.testing.assert_array_equal(weight, 1.0)
    np.testing.assert_allclose(dot(o, o), 1.0, rtol=1e-14)
    cosine = dot(v, m)
    # o in the frame of its side points away from that side's facets: both cosines are positive
    assert np.all(dot(o, m) > 0.0)
    # reflected: mirrored at m
    np.testing.assert_allclose((v + o)[~crossed], 2.0 * (cosine[:, None] * m)[~crossed], atol=1e-14)
    # refracted: the tangential part over eta, and straight on, which in the frame of the other
    # side is along that of v
    v, o, m, cosine = v[crossed], o[crossed], m[crossed], cosine[crossed]
    tangential = v - cosine[:, None] * m
    np.testing.assert_allclose(o - dot(o, m)[:, None] * m, tangential / eta, atol=1e-14)
    # all that is beyond the critical angle reflects
    assert np.all(cosine > critical_cosine(eta))
    # the way back: same facet, other side, ends where it began
    back = Dielectric(ior).scatter(o, m, ~side[crossed], np.random.default_rng(0))
    again = back.crossed
    np.testing.assert_allclose(back.o[again], v[again], atol=1e-7)  # grazing: square roots of 1e-16
    assert again.sum() > 100


@pytest.mark.parametrize("below", SIDES, ids=side_id)
def test_an_index_of_1_lets_all_pass_straight_on(below):
    v, m, side, rng = vertices(SURFACES[0], below)
    o, crossed, _ = Dielectric(1.0).scatter(v, m, side, rng)
    assert np.all(crossed)
    np.testing.assert_allclose(o, v, atol=1e-14)


def test_chance_to_reflect_is_the_reflectance():
    v = np.broadcast_to(direction(1.2), (200_000, 3))
    m = np.broadcast_to(direction(0.1), v.shape)
    rng = np.random.default_rng(4)
    _, crossed, _ = Dielectric(1.5).scatter(v, m, np.zeros(v.shape[0], bool), rng)
    expected = float(dielectric_reflectance(np.array(np.cos(1.1)), 1.5))
    error = np.sqrt(expected * (1.0 - expected) / v.shape[0])
    assert abs((~crossed).mean() - expected) < 4.0 * error


def refracted(v, m, eta):
    """o of facets ``m``, written from the angles, unlike the code that is tested."""
    cos_i = dot(v, m)
    sin_t = np.sqrt(1.0 - cos_i**2) / eta
    along = normalize(v - cos_i[..., None] * m)
    return sin_t[..., None] * along + np.sqrt(1.0 - sin_t**2)[..., None] * m


def steradians(turned, m, step=1e-5):
    """Steradians of ``turned(m)`` per steradian of ``m`` ``(n, 3)``, by central differences."""
    frames = np.stack([basis(one) for one in m])
    slopes = [
        (turned(normalize(m + step * axis)) - turned(normalize(m - step * axis))) / (2.0 * step)
        for axis in (frames[:, 0], frames[:, 1])
    ]
    return np.linalg.norm(np.cross(*slopes), axis=-1)


@pytest.mark.parametrize("below", SIDES, ids=side_id)
@pytest.mark.parametrize("ior", IORS, ids=ior_id)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_dielectric_vertex_term_is_the_facets_density(surface, ior, below):
    # <v,m> D(m) per steradian of m, divided by the steradians of o that m's steradian fills
    v, m, side, _ = vertices(surface, below, 2000)
    eta = 1.0 / ior if below else ior
    clear = (dot(v, m) > critical_cosine(eta) + 0.02) & (dot(v, m) > 0.02) & (dot(v, m) < 0.999)
    v, m, side = v[clear], m[clear], side[clear]
    assert v.shape[0] > 50
    material, density = Dielectric(ior), partial(D, surface=surface)
    share = dot(v, m) * D(m, surface)
    reflectance = dielectric_reflectance(dot(v, m), eta)
    for crossed, chance, turned in (
        (False, reflectance, lambda n: 2.0 * dot(v, n)[:, None] * n - v),
        (True, 1.0 - reflectance, lambda n: refracted(v, n, eta)),
    ):
        o = turned(m)
        turn = material.turn(v, o, None, side, np.full(side.shape, crossed), density)
        # 1e-5: differences of step 1e-5, near angles where o moves quickly with m
        np.testing.assert_allclose(turn.density, share / steradians(turned, m), rtol=1e-5)
        np.testing.assert_allclose(turn.choice, chance, rtol=1e-9)
        np.testing.assert_array_equal(turn.weight[:, 0], turn.choice)
        # the reverse: the same in terms of facets, so densities of energy differ by eta^2
        reverse = material.turn(o, v, None, side ^ crossed, np.full(side.shape, crossed), density)
        forward, backward = turn.density * turn.weight[:, 0], reverse.density * reverse.weight[:, 0]
        ratio = eta * eta if crossed else 1.0
        np.testing.assert_allclose(forward, ratio * backward, rtol=1e-9)


@pytest.mark.parametrize("surface", SURFACES, ids=name)
@pytest.mark.parametrize("crossed", SIDES, ids=["reflected", "transmitted"])
def test_no_facet_turns_light_the_wrong_way(surface, crossed):
    # directions that only a facet with m.z < 0, or one seen from its back, would connect
    rng = np.random.default_rng(5)
    v, o = normalize(rng.standard_normal((2, 4000, 3)))
    for ior in IORS:
        turn = Dielectric(ior).turn(
            v, o, None, np.array(False), np.array(crossed), partial(D, surface=surface)
        )
        h = ior * o - v if crossed else v + o
        h = normalize(h * (np.sign(ior - 1.0) if crossed else 1.0))
        # D itself is 0 below the horizon, and where Beckmann's underflows
        legal = (D(h, surface) > 0.0) & (dot(v, h) > 0.0) & (dot(o, h) > 0.0)
        np.testing.assert_array_equal(turn.density[~legal], 0.0)
        assert np.all(turn.density[legal] > 0.0)
        assert 0 < legal.sum() < legal.size


@pytest.mark.parametrize("theta", [0.0, 0.7, 1.5, 1.9], ids="theta={}".format)
@pytest.mark.parametrize("below", SIDES, ids=side_id)
@pytest.mark.parametrize("ior", IORS, ids=ior_id)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_dielectric_vertex_terms_sum_to_one(surface, ior, below, theta):
    v, material = direction(theta, 0.6), Dielectric(ior)
    total = 0.0
    for crossed, zone in enumerate(facet_zones(v, 1.0 / ior if below else ior)):
        o, weight = zone.rule()
        turn = material.turn(
            v, o, None, np.array(below), np.array(bool(crossed)), partial(D, surface=surface)
        )
        total += (turn.density * turn.weight[:, 0] * weight).sum()
    assert total / float(sigma(v, surface)) == pytest.approx(1.0, rel=QUADRATURE)


@pytest.mark.parametrize("theta", [0.0, 0.7, 1.5, 1.9], ids="theta={}".format)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_conductor_vertex_term_sums_to_one(surface, theta):
    v = direction(theta, 0.6)
    o, weight = facet_zones(v)[0].rule()
    turn = Conductor().turn(
        v, o, None, np.array(False), np.array(False), partial(D, surface=surface)
    )
    total = (turn.density * turn.weight[:, 0] * weight).sum() / float(sigma(v, surface))
    assert total == pytest.approx(1.0, rel=QUADRATURE)


@pytest.mark.parametrize("theta", [0.7, 1.9], ids="theta={}".format)
@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_diffuse_vertex_term_sums_to_its_albedo(surface, theta):
    v, albedo = direction(theta, 0.6), (0.2, 0.5, 1.0)
    m, m_weight = visible_normals(v, surface, 20)
    total = np.zeros(3)
    for one, share in zip(m, m_weight, strict=True):
        o, weight = Zone(one, np.pi / 2).rule(12)
        turn = Diffuse(albedo).turn(
            v, o, one, np.array(False), np.array(False), partial(D, surface=surface)
        )
        total += share * (turn.density[:, None] * turn.weight * weight[:, None]).sum(axis=0)
    # compared with the same rule over micronormals, whose 20 points a side are good to 1e-3 only;
    # that over directions about m is good to 1e-10
    area = (np.maximum(dot(v, m), 0.0) * D(m, surface) * m_weight).sum()
    np.testing.assert_allclose(total / area, albedo, rtol=1e-9)
    assert area == pytest.approx(float(sigma(v, surface)), rel=1e-3)


def test_mirrors_and_matte_facets_are_symmetric():
    surface, gold = SURFACES[1], Conductor(F82Tint((0.9, 0.5, 0.2), (0.8, 0.9, 1.0)))
    v, m, side, _ = vertices(surface, False)
    o = 2.0 * dot(v, m)[:, None] * m - v
    for material, facet in ((gold, None), (Diffuse((0.2, 0.5, 0.9)), m)):
        for crossed in (False, True):
            cross = np.full(side.shape, crossed)
            there = material.turn(v, o, facet, side, cross, partial(D, surface=surface))
            back = material.turn(o, v, facet, side, cross, partial(D, surface=surface))
            product = there.density[:, None] * there.weight
            np.testing.assert_allclose(
                product, back.density[:, None] * back.weight, rtol=1e-9, atol=1e-300
            )
            assert np.all(product == 0.0) if crossed else np.all(product >= 0.0)
            assert np.all(product[dot(o, m) > 0.0] > 0.0) or crossed


def test_mirrors_reflect_with_the_fresnel_factor():
    fresnel = IndexOfRefraction((0.20, 0.92, 1.10), (3.91, 2.45, 2.14))
    v, m, side, rng = vertices(SURFACES[0], False)
    o, crossed, weight = Conductor(fresnel).scatter(v, m, side, rng)
    np.testing.assert_allclose(v + o, 2.0 * dot(v, m)[:, None] * m, atol=1e-14)
    np.testing.assert_allclose(weight, fresnel(dot(v, m)), rtol=1e-14)
    assert not np.any(crossed)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Dielectric(0.0), r"ior is 0\.0; give a ratio from 1e-08 to 1e\+08"),
        (lambda: Dielectric(-1.5), r"ior is -1\.5"),
        (lambda: Dielectric(np.nan), "ior is nan"),
        (lambda: Dielectric(np.inf), "ior is inf"),
        (lambda: Diffuse((0.5, 0.5, 1.2)), r"albedo is \(0\.5, 0\.5, 1\.2\); give three finite"),
        (lambda: Diffuse((0.5, 0.5)), r"albedo is \(0\.5, 0\.5\)"),
        (lambda: Diffuse((0.5, np.nan, 0.5)), "albedo is"),
        (lambda: Surface(0.5, 0.5, material="gold"), "material is 'gold'; give a Conductor"),
        (lambda: Surface(0.5, 0.5, model="NONE"), "model is 'NONE'; give one of CORRELATED"),
        (
            lambda: evaluate(
                direction(0.3), direction(0.4), Surface(0.5, 0.5, material=Dielectric(1.0)), 1, 2
            ),
            "ior is 1, where all light goes straight on",
        ),
    ],
)
def test_bad_values_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()
