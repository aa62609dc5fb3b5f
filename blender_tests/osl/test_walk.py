# SPDX-License-Identifier: GPL-3.0-or-later
"""The walk (walk.h) and its random numbers (random.h) against the oracle's energies."""

import numpy as np
import pytest

from blender_tests.oracle.estimate import energies
from blender_tests.oracle.fresnel import F82Tint
from blender_tests.oracle.materials import Conductor
from blender_tests.oracle.surface import BECKMANN, Surface
from blender_tests.oracle.vectors import direction
from blender_tests.oracle.walk import bounces

from .probe import evaluate
from .samples import DISTRIBUTIONS, SURFACE

COUNT = 40_000
STREAM = (
    "RandomStream stream; stream.origin = point(where); stream.counter = 0;"
    "Conductor metal; metal.physical = 0; metal.first = color(0.9, 0.5, 0.1); metal.second = 1;"
)
ROUGH = [(0.5, 0.5), (1.0, 1.0), (1.0, 0.1)]


def shade(
    surface: Surface, theta: float, statements: str, includes: str = "walk.h", count: int = COUNT
) -> np.ndarray:
    """`statements` at `count` random points of a surface seen from `theta`, (count, 3)."""
    widths = np.float32([surface.alpha_x, surface.alpha_y, surface.distribution == BECKMANN])
    return evaluate(
        includes,
        f"{SURFACE} {STREAM} {statements}",
        alpha=np.tile(widths, (count, 1)),
        wi=np.tile(direction(theta, 0.6), (count, 1)),
        where=np.random.default_rng(9).uniform(-10.0, 10.0, (count, 3)),
    ).astype(float)


def agree(found: np.ndarray, wanted: np.ndarray) -> None:
    """Means of two independent samples (n, 3) and (m, 3) differ by at most 4.5 standard errors."""
    error = np.sqrt(found.var(axis=0) / len(found) + wanted.var(axis=0) / len(wanted))
    assert np.all(np.abs(found.mean(axis=0) - wanted.mean(axis=0)) < 4.5 * error + 1e-6)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("alpha", ROUGH)
@pytest.mark.parametrize("theta", [0.2, 1.2])
def test_chosen_vertices_carry_the_kept_energy(
    distribution: str, alpha: tuple[float, float], theta: float
) -> None:
    """Weighted by `kept`, the directions of the vertices chosen among candidates have the moments
    of all vertices weighted by the energy that stays: where the weight goes and how it spreads."""
    surface = Surface(*alpha, distribution)
    wi = np.tile(direction(theta, 0.6), (400_000, 1))
    vertex = next(bounces(wi, surface, 1, np.random.default_rng(10)))
    kept = (
        "float kept; Vertex chosen = sample_kept_vertex(surface, incidence(surface, wi),"
        "next_numbers(stream), 8, 4, stream, kept);"
    )
    agree(shade(surface, theta, kept + "result = kept * chosen.o;"), vertex.staying * vertex.o)
    agree(
        shade(surface, theta, kept + "result = kept * chosen.o * chosen.o;"),
        vertex.staying * vertex.o**2,
    )


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("alpha", ROUGH)
def test_energy_of_walks(distribution: str, alpha: tuple[float, float]) -> None:
    """Coloured energies of up to 1, 2 and 5 bounces are the oracle's."""
    theta = 0.9
    surface = Surface(*alpha, distribution, Conductor(F82Tint((0.9, 0.5, 0.1), (1.0, 1.0, 1.0))))
    found = energies(direction(theta, 0.6), surface, 5, 100_000, np.random.default_rng(11)).both
    for most in (1, 2, 5):
        walked = shade(
            surface,
            theta,
            "color weight = 1; vector o = walk_to_exit(surface, metal, wi, 0,"
            f"{most}, 0, stream, weight); result = vector(weight);",
        )
        wanted = found.mean[:most].sum(axis=0)
        error = np.sqrt(walked.var(axis=0) / COUNT + found.variance[:most].sum(axis=0))
        assert np.all(np.abs(walked.mean(axis=0) - wanted) < 4.5 * error)


def test_tolerance_bounds_what_is_lost() -> None:
    """A path is dropped only when its throughput is below the tolerance."""
    surface = Surface(1.0, 1.0)
    walk = (
        "color weight = 1; vector o = walk_to_exit(surface, metal, wi, 0, 32, {}, stream, weight);"
        "result = vector(weight);"
    )
    whole, cut = (shade(surface, 0.5, walk.format(tolerance)) for tolerance in (0.0, 0.7))
    lost = np.abs(whole - cut).max(axis=1)
    assert np.any(lost > 0.0)
    assert np.all(lost < 0.7)


def test_random_numbers_are_uniform_and_independent() -> None:
    """Mean, variance and correlations of consecutive draws at random points."""
    draws = (
        shade(Surface(0.5, 0.5), 0.0, "result = next_numbers(stream);"),
        shade(Surface(0.5, 0.5), 0.0, "next_numbers(stream); result = next_numbers(stream);"),
    )
    u = np.concatenate(draws, axis=1)
    assert u.min() >= 0.0
    assert u.max() <= 1.0
    assert np.all(np.abs(u.mean(axis=0) - 0.5) < 4.5 * np.sqrt(1 / 12 / COUNT))
    assert np.all(np.abs(u.var(axis=0) - 1 / 12) < 4.5 * np.sqrt(1 / 180 / COUNT))
    correlation = np.corrcoef(u.T) - np.eye(6)
    assert np.max(np.abs(correlation)) < 4.5 / np.sqrt(COUNT)


def test_lattice_points_are_uniform_and_spread() -> None:
    """Every point of the shifted lattice is uniform; 16 in a row fill each eighth of the cube."""
    shifts = np.random.default_rng(12).random((2000, 3))
    point = [
        evaluate("random.h", f"result = lattice_point({i}, shift);", shift=shifts)
        for i in range(16)
    ]
    points = np.stack(point)
    assert np.all(np.abs(points.mean(axis=1) - 0.5) < 4.5 * np.sqrt(1 / 12 / 2000))
    octant = (points > 0.5) @ np.array([1, 2, 4])
    filled = np.array([len(np.unique(octant[:, k])) for k in range(2000)])
    chance = 8 * (1 - (7 / 8) ** 16)  # of independent points
    assert filled.mean() > chance + 0.1
