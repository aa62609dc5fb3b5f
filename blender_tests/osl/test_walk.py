# SPDX-License-Identifier: GPL-3.0-or-later
"""The walk (walk.h) and its random numbers (random.h) against the oracle's energies."""

from itertools import product

import numpy as np
import pytest

from osl.oracle.estimate import energies
from osl.oracle.fresnel import F82Tint
from osl.oracle.materials import Conductor, Dielectric, Diffuse, Material
from osl.oracle.surface import GGX, MODELS, Surface
from osl.oracle.vectors import direction
from osl.oracle.walk import bounces

from .probe import evaluate
from .samples import DISTRIBUTIONS, SURFACE, widths

COUNT = 20_000
STREAM = "RandomStream stream; stream.origin = point(where); stream.counter = 0;"
ROUGH = [(0.5, 0.5), (1.0, 1.0), (1.0, 0.1)]
GOLD = Conductor(F82Tint((0.9, 0.5, 0.1), (1.0, 1.0, 1.0)))
MATERIALS = [GOLD, Diffuse((0.9, 0.5, 0.1)), Dielectric(1.5), Dielectric(1 / 1.5), Dielectric(2.4)]
NAMES = ["conductor", "diffuse", "glass", "glass from inside", "diamond"]


def osl_material(material: Material) -> str:
    """OSL statements that make a `material` of the oracle's."""
    kind = "Material material; material.kind ="
    if isinstance(material, Conductor):
        rows = ("first = color(0.9, 0.5, 0.1)", "second = 1", "physical = 0")
        return f"{kind} CONDUCTOR;" + "".join(f"material.metal.{r};" for r in rows)
    if isinstance(material, Diffuse):
        return f"{kind} DIFFUSE; material.tint = color{material.albedo};"
    return f"{kind} DIELECTRIC; material.tint = 1; material.ior = {material.ior!r};"


def shade(
    surface: Surface, theta: float, statements: str, includes: str = "walk.h", count: int = COUNT
) -> np.ndarray:
    """`statements` at `count` random points of a surface seen from `theta`, (count, 3)."""
    return shade_all([surface], theta, statements, includes, count)[0]


def shade_all(
    surfaces: list[Surface],
    theta: float,
    statements: str,
    includes: str = "walk.h",
    count: int = COUNT,
) -> np.ndarray:
    """The same of surfaces of one material in one picture, (surfaces, count, 3)."""
    alpha = np.repeat([widths(surface) for surface in surfaces], count, axis=0)
    found = evaluate(
        includes,
        f"{SURFACE} {STREAM} {osl_material(surfaces[0].material)} {statements}",
        alpha=alpha,
        wi=np.tile(direction(theta, 0.6), (len(alpha), 1)),
        where=np.random.default_rng(9).uniform(-10.0, 10.0, (len(alpha), 3)),
    )
    return found.reshape(len(surfaces), count, 3).astype(float)


def agree(found: np.ndarray, wanted: np.ndarray) -> None:
    """Means of two independent samples (n, 3) and (m, 3) differ by at most 4.5 standard errors."""
    error = np.sqrt(found.var(axis=0) / len(found) + wanted.var(axis=0) / len(wanted))
    assert np.all(np.abs(found.mean(axis=0) - wanted.mean(axis=0)) < 4.5 * error + 1e-6)


@pytest.mark.nightly
@pytest.mark.parametrize("theta", [0.2, 1.2])
def test_chosen_vertices_carry_the_kept_energy(theta: float) -> None:
    """Weighted by `kept`, the directions of the vertices chosen among candidates have the moments
    of all vertices weighted by the energy that stays: where the weight goes and how it spreads."""
    surfaces = [Surface(*alpha, kind, GOLD) for alpha, kind in product(ROUGH, DISTRIBUTIONS)]
    kept = (
        "Incidence arrival = incidence(surface, wi); float kept;"
        "Vertex chosen = sample_kept_vertex(surface, material, arrival,"
        "walker_from(surface, arrival, stream), next_numbers(stream), 8, 4, stream, kept);"
    )
    first = shade_all(surfaces, theta, kept + "result = kept * chosen.o;", count=2 * COUNT)
    squared = kept + "result = kept * chosen.o * chosen.o;"
    second = shade_all(surfaces, theta, squared, count=2 * COUNT)
    wi = np.tile(direction(theta, 0.6), (200_000, 1))
    for surface, mean, square in zip(surfaces, first, second, strict=True):
        white = Surface(surface.alpha_x, surface.alpha_y, surface.distribution)
        vertex = next(bounces(wi, white, 1, np.random.default_rng(10)))
        agree(mean, vertex.staying * vertex.o)
        agree(square, vertex.staying * vertex.o**2)


@pytest.mark.parametrize("material", MATERIALS, ids=NAMES)
@pytest.mark.parametrize("most", [1, 5])
def test_energy_of_walks(material: Material, most: int) -> None:
    """Energies of up to 1 and 5 bounces, reflected and transmitted, are the oracle's."""
    theta = 0.9
    surfaces = [
        Surface(1.0, 0.5, distribution, material, model)
        for distribution, model in product(DISTRIBUTIONS, MODELS)
    ]
    walked = shade_all(
        surfaces,
        theta,
        "Walker walker = walker_from(surface, incidence(surface, wi), stream);"
        f"vector o = walk_to_exit(surface, material, 0, {most}, 0, 0, stream, walker);"
        "result = (walker.below ? -1 : 1) * vector(walker.throughput);",
    )
    for surface, weights in zip(surfaces, walked, strict=True):
        found = energies(direction(theta, 0.6), surface, most, 50_000, 11)
        for sign, lobes in ((1.0, found.reflected), (-1.0, found.transmitted)):
            side = np.maximum(sign * weights, 0.0)
            wanted = lobes.mean.sum(axis=0)
            error = np.sqrt(side.var(axis=0) / COUNT + lobes.variance.sum(axis=0))
            off = np.abs(side.mean(axis=0) - wanted)
            assert np.all(off < 4.5 * error + 1e-6), f"{surface}, {sign:+.0f}"


@pytest.mark.parametrize("material", [GOLD, Dielectric(1.5)], ids=["conductor", "glass"])
def test_one_bounce_alone(material: Material) -> None:
    """`only` k gives the oracle's energy of bounce k."""
    surface = Surface(1.0, 1.0, GGX, material)
    found = energies(direction(0.9, 0.6), surface, 4, 100_000, 12).both
    for only in (1, 2, 4):
        walked = shade(
            surface,
            0.9,
            "Walker walker = walker_from(surface, incidence(surface, wi), stream);"
            f"vector o = walk_to_exit(surface, material, 0, 16, {only}, 0, stream, walker);"
            "result = vector(walker.throughput);",
        )
        error = np.sqrt(walked.var(axis=0) / COUNT + found.variance[only - 1])
        assert np.all(np.abs(walked.mean(axis=0) - found.mean[only - 1]) < 4.5 * error)


def test_tolerance_bounds_what_is_lost() -> None:
    """A path is dropped only when its throughput is below the tolerance."""
    surface = Surface(1.0, 1.0)
    walk = (
        "Walker walker = walker_from(surface, incidence(surface, wi), stream);"
        "vector o = walk_to_exit(surface, material, 0, 32, 0, {}, stream, walker);"
        "result = vector(walker.throughput);"
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
    points = evaluate(
        "random.h",
        "result = lattice_point(int(index), shift);",
        shift=np.tile(shifts, (16, 1)),
        index=np.repeat(np.arange(16.0), 2000),
    ).reshape(16, 2000, 3)
    assert np.all(np.abs(points.mean(axis=1) - 0.5) < 4.5 * np.sqrt(1 / 12 / 2000))
    octant = (points > 0.5) @ np.array([1, 2, 4])
    filled = np.array([len(np.unique(octant[:, k])) for k in range(2000)])
    chance = 8 * (1 - (7 / 8) ** 16)  # of independent points
    assert filled.mean() > chance + 0.1
