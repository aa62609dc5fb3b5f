# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted anisotropic metal: against the oracle, in white furnaces, and where it is nearly isotropic
or nearly smooth."""

from itertools import pairwise

import bpy
import numpy as np
import pytest

from blender_tests.stability.test_energy import FACETS, PIXELS, Case, build
from osl.oracle import BECKMANN, GGX, Conductor, Surface, energies, sphere
from osl.oracle.reference_cases import GOLD
from scenes import pictures
from scenes.pictures import WHITE, Widths

from .test_fitted import LARGEST_NOISE_RATIO, hold_noise

pytestmark = pytest.mark.nightly

DISTRIBUTIONS = ("GGX", "Beckmann")
GOLD_INPUTS = {"BaseColor": (0.95, 0.75, 0.35), "EdgeTint": (0.98, 0.95, 0.75)}
LIMIT = 0.05
LIMIT_OF_NOISE = LARGEST_NOISE_RATIO["sphere_sun"]
SCENE = "sphere_sun_conductor"
ROUGH = [(1, 0.1), (1, 0.3), (1, 0.6), (1, 0.85), (1, 0.95), (0.7, 0.07), (0.8, 0.5), (0.5, 0.05)]
SMOOTH = [(0.5, 0.15), (0.5, 0.45), (0.25, 0.1), (0.1, 0.03), (0.03, 0.003), (1e-3, 1e-4)]
SAMPLES = 1024

by_distribution = pytest.mark.parametrize("distribution", DISTRIBUTIONS)


@by_distribution
def test_sphere(distribution: str, report) -> None:
    """White, alphas 1 and 0.1, under the sun."""
    wanted = pictures.reference(f"sun_white_{distribution.lower()}_1_0.1")
    found = pictures.render_fixture(
        SCENE,
        64,
        Quality="Fitted",
        Distribution=distribution,
        **WHITE,
        **Widths(1.0, 0.1).inputs,
    )
    error = pictures.l2_error(found, wanted["mean"], wanted["mask"])
    energy = pictures.energy_ratio(found, wanted["mean"], wanted["mask"])
    name = f"Fitted, sun_white_{distribution.lower()}_1_0.1"
    report(name, f"{error:.2%}, energy {energy:.4f}", f"{LIMIT:.0%}")
    assert error < LIMIT


@by_distribution
def test_furnace(distribution: str, report) -> None:
    """Mean of each surface within 0.003 of 1, and each of its views within 0.01."""
    kind = DISTRIBUTIONS.index(distribution)
    cases = [Case(Widths(*alphas), kind, 0) for alphas in ROUGH + SMOOTH]
    build("CONDUCTOR", "Fitted", cases)
    views = _views(pictures.picture(SAMPLES).mean(axis=-1), len(cases))
    means = views.mean(axis=1)
    found = f"{means.min():.4f} .. {means.max():.4f}, views {views.min():.4f} .. {views.max():.4f}"
    report(f"furnaces, anisotropic Fitted, {distribution}", found, "1 +- 0.003, views 0.01")
    assert np.abs(means - 1.0).max() < 0.003
    assert np.abs(views - 1.0).max() < 0.01


@by_distribution
def test_gold_in_a_furnace(distribution: str, report) -> None:
    """Each channel keeps the oracle's energy within 1 %, seen from many sides."""
    found, wanted = _furnace(distribution, Conductor(GOLD), 16, **GOLD_INPUTS)
    ratios = found.mean(axis=0) / wanted.mean(axis=0)
    name = f"furnace, anisotropic gold, Fitted, {distribution}: R, G, B"
    report(name, ", ".join(f"{r:.4f}" for r in ratios), "1 +- 0.01")
    assert np.abs(ratios - 1.0).max() < 0.01


@by_distribution
@pytest.mark.parametrize("bounces", [2, 3])
def test_max_bounces(bounces: int, distribution: str, report) -> None:
    """White metal loses what would leave later, within 0.01 of the light."""
    found, wanted = _furnace(distribution, Conductor(), bounces, **WHITE)
    error = float(found.mean() - wanted.mean())
    name = f"furnace, anisotropic Fitted, {distribution}, {bounces} bounces"
    report(name, f"{found.mean():.4f}, {error:+.4f}", "0.01")
    assert abs(error) < 0.01


@by_distribution
def test_nothing_jumps_where_the_surface_becomes_isotropic(distribution: str, report) -> None:
    """The picture under the sun from step to step of the slider."""
    values = {**WHITE, "Roughness": 0.9, "Distribution": distribution, "Quality": "Fitted"}
    steps = (0.0, 1e-4, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14)
    seen = [pictures.render_fixture(SCENE, 16, Anisotropy=one, **values) for one in steps]
    mask = pictures.reference("sun_white_ggx_1")["mask"]
    changes = [pictures.l2_error(b, a, mask) for a, b in pairwise(seen)]
    found = f"{changes[0]:.2%} at once, then {min(changes[1:]):.2%} .. {max(changes[1:]):.2%}"
    report(f"slider of anisotropy, Fitted, {distribution}", found, "0.1%, 1.5%")
    assert changes[0] < 0.001
    assert max(changes) < 0.015


@by_distribution
def test_noise_is_that_of_a_single_bounce(distribution: str, report) -> None:
    """As for isotropic metal, under a sun of half a radian."""
    metal = pictures.open_scene(SCENE)
    bpy.data.objects["Sun"].data.angle = 0.5
    pictures.set_values(metal, {**WHITE, "Distribution": distribution, **Widths(1.0, 0.1).inputs})
    hold_noise(f"sphere_sun, conductor, {distribution} 1_0.1", metal, LIMIT_OF_NOISE, report)


def _furnace(
    distribution: str, material: Conductor, bounces: int, **values: object
) -> tuple[np.ndarray, np.ndarray]:
    """Pixels (n, 3) of the sphere in the furnace, and the oracle's energies."""
    surface = Surface(1.0, 0.1, BECKMANN if distribution == "Beckmann" else GGX, material)
    values |= {"Distribution": distribution, "MaxBounces": bounces, **Widths(1.0, 0.1).inputs}
    image = pictures.render_fixture("furnace_conductor", 64, Quality="Fitted", **values)
    view = sphere.view(subsamples=1)
    rows = range(4, len(image), 8)
    found = np.concatenate([image[row, view.mask[row]] for row in rows])
    wi = np.concatenate([view.row(row)[0][:, 0] for row in rows])
    return found, energies(wi, surface, bounces, 500, 1).both.total


def _views(image: np.ndarray, cases: int) -> np.ndarray:
    """Means over the facets (cases, FACETS) of a picture of them (rows, columns)."""
    return image.reshape(cases, PIXELS, FACETS, PIXELS).mean(axis=(1, 3))
