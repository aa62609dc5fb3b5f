# SPDX-License-Identifier: GPL-3.0-or-later
"""The directions to which facets turn paths, against the density of turning, by chi-square tests.

Cells cover all directions that some facet turns a path to, by reflection and by transmission. One
that goes elsewhere is an error. (Heights are tested in test_masking.py, micronormals in
test_visible.py.)
"""

from functools import partial

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, Surface
from osl.oracle.chi_square import count_in_cells, integrate_cells, p_value, sidak
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import Zone, facet_zones, visible_normals
from osl.oracle.surface import BECKMANN, GGX
from osl.oracle.vectors import direction, dot
from osl.oracle.visible import sample

WIDTHS = [(0.5, 0.5), (1.0, 0.3), (0.25, 0.25)]
# v above the horizon, next to it, and below it
ANGLES = [0.3, 1.2, 1.56, 2.0]
# and the side that v is on
FACETS = [
    (Conductor(), False),
    *((Dielectric(ior), False) for ior in (1.1, 1.5, 2.4, 1.0 / 1.5)),
    *((Dielectric(ior), True) for ior in (1.5, 2.4)),
]
SMOOTH = [
    (Surface(*alpha, ndf, material), theta, below)
    for ndf in (GGX, BECKMANN)
    for alpha in WIDTHS
    for theta in ANGLES
    for material, below in FACETS
]
MATTE = [
    (Surface(*alpha, ndf, Diffuse()), theta)
    for ndf in (GGX, BECKMANN)
    for alpha in WIDTHS
    for theta in ANGLES
]
FACET_ANGLES = [0.0, 0.8, 1.5]
# One chance in a hundred that the whole family of tests fails a right sampler.
SIGNIFICANCE = sidak(len(SMOOTH) + len(MATTE) + len(FACET_ANGLES))
DRAWS = 100_000
SIDE = 10  # even edges of cells, and as many that make cells of equal counts
NODES = 8  # of the rule in a cell, a side
RULE = 3e-4  # its error, measured: at most 1.1e-4, where F of IOR 1.1 begins to rise steeply


def name(value):
    if isinstance(value, Surface):
        material = type(value.material).__name__
        ior = f"-{value.material.ior:.3g}" if value.material.transmits else ""
        return f"{value.distribution}-{value.alpha_x}-{value.alpha_y}-{material}{ior}"
    if isinstance(value, bool):
        return "below" if value else "above"
    return f"theta={value}"


def draw(surface, v, below, count=DRAWS, seed=20):
    rng = np.random.default_rng([seed, below])
    many = np.broadcast_to(v, (count, 3))
    return surface.material.scatter(many, sample(many, surface, rng), np.full(count, below), rng)


def zones(surface, v, below):
    """Where facets reflect v to and, where they do, transmit it to."""
    transmits = surface.material.transmits
    return facet_zones(v, float(surface.material.eta(np.array(below))) if transmits else None)


def edges(values, ends):
    """Edges of cells: ``ends``, and between them some that are even and some between which equally
    many of ``values`` lie."""
    even = np.linspace(ends[0], ends[-1], SIDE)
    equal = np.quantile(values, np.linspace(0.0, 1.0, SIDE)) if values.size > SIDE else []
    return np.unique([*ends, *even, *equal])


def cells(surface, v, below):
    """Edges in the coordinates of each zone, made from draws of their own."""
    pilot = draw(surface, v, below, 20_000, 19)
    found = []
    for crossed, zone in enumerate(zones(surface, v, below)):
        angle, share = zone.coordinates(pilot.o[pilot.crossed == crossed])
        # the azimuth's share changes sign where o turns through v's own plane
        found.append((edges(angle, zone.breaks), edges(share, np.array([-1.0, 0.0, 1.0]))))
    return found


def expected_counts(surface, v, below, grids):
    """Draws expected in the cells of all zones, ``(cells,)``."""
    counts = []
    for crossed, (zone, grid) in enumerate(zip(zones(surface, v, below), grids, strict=True)):

        def density(angle, share, crossed=crossed, zone=zone):
            o, measure = zone.directions(angle, share)
            turn = surface.material.turn(
                v, o, None, np.array(below), np.array(bool(crossed)), partial(D, surface=surface)
            )
            return turn.density * turn.choice * measure

        counts.append(integrate_cells(density, *grid, NODES).ravel())
    return DRAWS / float(sigma(v, surface)) * np.concatenate(counts)


def observed_counts(scattered, zones, grids):
    """Draws found in the same cells."""
    counts = []
    for crossed, (zone, grid) in enumerate(zip(zones, grids, strict=True)):
        o = scattered.o[scattered.crossed == crossed]
        counts.append(count_in_cells(*zone.coordinates(o), *grid).ravel())
    return np.concatenate(counts)


def scatter_p_value(drawn, tested, theta, below):
    """p-value that draws of the surface ``drawn`` follow the density of the surface ``tested``."""
    v = direction(theta, 0.5)
    grids = cells(tested, v, below)
    expected = expected_counts(tested, v, below, grids)
    # the rule in the cells is far better than the noise of any cell
    assert expected.sum() == pytest.approx(DRAWS, rel=RULE)
    observed = observed_counts(draw(drawn, v, below), zones(drawn, v, below), grids)
    return p_value(observed, expected)


@pytest.mark.parametrize(("surface", "theta", "below"), SMOOTH, ids=name)
def test_directions_follow_the_vertex_term(surface, theta, below):
    assert scatter_p_value(surface, surface, theta, below) > SIGNIFICANCE


@pytest.mark.parametrize(("surface", "theta"), MATTE, ids=name)
def test_matte_directions_follow_the_mean_over_facets(surface, theta):
    v = direction(theta, 0.5)
    m, weight = visible_normals(v, surface, 24)
    share = np.maximum(dot(v, m), 0.0) * D(m, surface) * weight

    sphere = Zone(direction(0.0))

    def density(angle, turn):
        # the mean over Dvis(v, .) of <o,m> / pi
        o, measure = sphere.directions(angle, turn)
        cosine = np.maximum(o.reshape(-1, 3) @ m.T, 0.0) @ share
        return cosine.reshape(angle.shape) * measure / (np.pi * share.sum())

    grid = np.linspace(0.0, np.pi, 2 * SIDE), np.linspace(-1.0, 1.0, 2 * SIDE)
    observed = count_in_cells(*sphere.coordinates(draw(surface, v, False).o), *grid)
    assert p_value(observed, DRAWS * integrate_cells(density, *grid, 3)) > SIGNIFICANCE


@pytest.mark.parametrize("theta", FACET_ANGLES)
def test_matte_directions_follow_the_cosine_about_a_facet(theta):
    m = direction(theta, 2.0)
    rng = np.random.default_rng(21)
    many = np.broadcast_to(m, (DRAWS, 3))
    o = Diffuse().scatter(many, many, np.zeros(DRAWS, bool), rng).o
    angle, share = Zone(m).coordinates(o)
    assert np.all(angle <= np.pi / 2)
    # sin^2 of the angle from m is uniform, and so is the azimuth
    grid = np.linspace(0.0, 1.0, SIDE + 1), np.linspace(-1.0, 1.0, SIDE + 1)
    observed = count_in_cells(np.sin(angle) ** 2, share, *grid)
    assert p_value(observed, np.full((SIDE, SIDE), DRAWS / SIDE**2)) > SIGNIFICANCE


@pytest.mark.parametrize(
    "drawn",
    [
        Surface(0.515, 0.515),
        Surface(0.515, 0.515, BECKMANN),
        Surface(0.515, 0.515, material=Dielectric(1.5)),
        Surface(0.5, 0.5, material=Dielectric(1.53)),
        Surface(0.5, 0.5, material=Dielectric(1.47)),
    ],
    ids=name,
)
def test_a_wrong_density_is_detected(drawn):
    # the tests above have teeth: widths 3 % off and indices 2 % off must fail them
    material = Dielectric(1.5) if drawn.material.transmits else drawn.material
    tested = Surface(0.5, 0.5, drawn.distribution, material)
    assert scatter_p_value(drawn, tested, 1.2, False) < SIGNIFICANCE
