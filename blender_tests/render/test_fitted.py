# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted on a sun-lit sphere against the oracle, and its noise beside the single bounce's.

Limits are the product's promises. Where a picture has next to no noise its error is taken as it is;
the oracle's own noise, at most 0.5 %, is part of it.
"""

import bpy
import numpy as np
import pytest

from osl.oracle.sphere import sphere_points
from scenes import fixtures, pictures, variants
from scenes.pictures import WHITE, Widths

from .test_converged import CLAY
from .test_sphere_sun import COLOURED

pytestmark = pytest.mark.nightly

ALPHAS = (0.1, 0.25, 0.5, 0.75, 1.0)
DISTRIBUTIONS = ("GGX", "Beckmann")
LIMIT_OF_METAL = LIMIT_OF_MATTE = 0.02
# In a uniform world what noise Single has is that of how evenly Cycles spreads the samples of one
# closure; picking among three breaks that. 1.29 was measured at GGX 0.5, 1.2 or less elsewhere.
LARGEST_NOISE_RATIO = {"sphere_sun": 1.2, "furnace": 1.35}
SAMPLES = 64
NOISE_SAMPLES = 16
SEEDS = 8
MASK = sphere_points(fixtures.RESOLUTION, 1)[1]

by_distribution = pytest.mark.parametrize("distribution", DISTRIBUTIONS)


@by_distribution
@pytest.mark.parametrize("alpha", ALPHAS)
def test_metal(alpha: float, distribution: str, report) -> None:
    """White, beside Cycles' own, which compensates energy for GGX alone."""
    name = f"sun_white_{distribution.lower()}_{alpha:g}"
    values = {**WHITE, "Distribution": distribution, **Widths(alpha, alpha).inputs}
    _hold(name, "sphere_sun_conductor", values, LIMIT_OF_METAL, report)


@pytest.mark.parametrize("name", COLOURED)
def test_coloured_metal(name: str, report) -> None:
    """Each channel keeps its energy within 1 %."""
    values = {**COLOURED[name], **Widths(0.5, 0.5).inputs}
    found, wanted = _hold(name, "sphere_sun_conductor", values, LIMIT_OF_METAL, report)
    _hold_channels(name, found, wanted, report)


@pytest.mark.parametrize(
    ("distribution", "alpha"), [(d, a) for d in DISTRIBUTIONS for a in (0.3, 1.0)]
)
def test_matte(alpha: float, distribution: str, report) -> None:
    """White."""
    name = f"sun_diffuse_{distribution.lower()}_{alpha:g}"
    values = {"Distribution": distribution, **Widths(alpha, alpha).inputs}
    _hold(name, "sphere_sun_diffuse", values, LIMIT_OF_MATTE, report)


def test_coloured_matte(report) -> None:
    """Each channel keeps its energy within 1 %."""
    values = {**CLAY, **Widths(1.0, 1.0).inputs}
    found, wanted = _hold("sun_clay_ggx_1", "sphere_sun_diffuse", values, LIMIT_OF_MATTE, report)
    _hold_channels("sun_clay_ggx_1", found, wanted, report)


@by_distribution
@pytest.mark.parametrize("alpha", [0.25, 0.5, 1.0])
@pytest.mark.parametrize("kind", ["conductor", "diffuse"])
@pytest.mark.parametrize("scene", ["sphere_sun", "furnace"])
def test_noise_is_that_of_a_single_bounce(
    scene: str, kind: str, alpha: float, distribution: str, report
) -> None:
    """The sun is half a radian wide, so that Single has noise as well."""
    material = pictures.open_scene(f"{scene}_{kind}")
    if scene == "sphere_sun":
        bpy.data.objects["Sun"].data.angle = 0.5
    pictures.set_values(material, {"Distribution": distribution, **Widths(alpha, alpha).inputs})
    name = f"{scene}, {kind}, {distribution} {alpha:g}"
    hold_noise(name, material, LARGEST_NOISE_RATIO[scene], report)


@pytest.mark.parametrize("kind", ["conductor", "diffuse"])
@pytest.mark.parametrize("bounces", [2, 3])
def test_max_bounces(kind: str, bounces: int, report) -> None:
    """Energy of a coloured furnace with the light of later bounces left out, against Exact."""
    material = pictures.open_scene(f"furnace_{kind}")
    tint = {"BaseColor": CLAY["Color"]} if kind == "conductor" else CLAY
    pictures.set_values(material, {**tint, **Widths(1.0, 1.0).inputs, "MaxBounces": bounces})
    means = {}
    for quality in ("Exact", "Fitted"):
        material.set("Quality", quality)
        means[quality] = pictures.picture(256)[MASK].mean(axis=0)
    off = np.abs(means["Fitted"] / means["Exact"] - 1.0).max()
    report(f"Fitted, {kind}, at most {bounces} bounces: energy", f"{off:.2%} off", "1%")
    assert off < 0.01


@pytest.mark.parametrize(
    "values",
    [{"Model": "height-tracked"}, {"BounceOnly": 2}],
    ids=["model", "bounce"],
)
@pytest.mark.parametrize("kind", ["conductor", "dielectric", "diffuse"])
def test_takes_walk_without_a_table(kind: str, values: dict[str, object]) -> None:
    """To the last bit."""
    fitted, walk = (
        pictures.render_fixture(f"sphere_sun_{kind}", 4, Quality=quality, **values)
        for quality in ("Fitted", "Walk")
    )
    assert walk.max() > 0.0
    assert np.array_equal(fitted, walk)


def hold_noise(name: str, material: variants.Material, limit: float, report) -> None:
    """The noise of Fitted in the open scene is at most `limit` times that of Single."""
    noise = {}
    for quality in ("Single", "Fitted"):
        material.set("Quality", quality)
        noise[quality] = pictures.relative_noise(NOISE_SAMPLES, SEEDS, MASK)
    ratio = noise["Fitted"] / noise["Single"]
    value = f"{ratio:.2f} ({noise['Fitted']:.2%} at {NOISE_SAMPLES} samples)"
    report(f"noise, {name}, Fitted / Single", value, str(limit))
    assert ratio <= limit


def _hold(
    name: str, scene: str, values: dict[str, object], limit: float, report
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    wanted = pictures.reference(name)
    mask, mean = wanted["mask"], wanted["mean"]
    found = pictures.render_fixture(scene, SAMPLES, Quality="Fitted", **values)
    error = pictures.l2_error(found, mean, mask)
    energy = pictures.energy_ratio(found, mean, mask)
    variants.use_cycles_multiscatter(variants.find_materials())
    own = pictures.l2_error(pictures.picture(SAMPLES), mean, mask)
    value = f"{error:.2%}, energy {energy:.4f}; Cycles' own {own:.1%}"
    report(f"Fitted, {name}", value, f"{limit:.0%}")
    assert error < limit
    return found, wanted


def _hold_channels(name: str, found: np.ndarray, wanted: dict[str, np.ndarray], report) -> None:
    mask = wanted["mask"]
    ratios = found[mask].mean(axis=0) / wanted["mean"][mask].mean(axis=0)
    report(f"Fitted, {name}: R, G, B", ", ".join(f"{r:.4f}" for r in ratios), "1 +- 0.01")
    assert np.abs(ratios - 1.0).max() < 0.01
