# SPDX-License-Identifier: GPL-3.0-or-later
"""The fast tier's pictures: every material, distribution, quality, model and side once.

Each picture is held to the oracle's. Its error is that of the converged picture
(`pictures.unbiased_l2_error`), so a few samples are enough. The nightly tests beside this one hold
more alphas, noise and the product's tighter promises.
"""

import numpy as np
import pytest

from osl.oracle.sphere import sphere_points
from scenes import fixtures, pictures
from scenes.pictures import WHITE, Widths
from scenes.references import Case

from .test_sphere_sun import COLOURED

GGX, BECKMANN = "GGX", "Beckmann"
CLAY = {"Color": (0.8, 0.5, 0.2)}
MASK = sphere_points(fixtures.RESOLUTION, 1)[1]

# Light, kind, alphas, distribution, model, quality, samples, limit of the error. A limit is half as
# large again as the error measured on Blender 5.2 and 4.5, or 1 % if that is more.
SUN = [
    ("sun", "CONDUCTOR", (0.5, 0.5), GGX, "correlated", "Single", 32, 0.01),
    ("sun", "CONDUCTOR", (1.0, 1.0), GGX, "correlated", "Fitted", 32, 0.02),
    ("sun", "CONDUCTOR", (0.5, 0.5), BECKMANN, "correlated", "Fitted", 32, 0.015),
    ("sun", "CONDUCTOR", (1.0, 0.1), GGX, "correlated", "Fitted", 32, 0.03),
    ("sun", "CONDUCTOR", (1.0, 0.1), BECKMANN, "correlated", "Walk", 64, 0.06),
    ("sun", "CONDUCTOR", (1.0, 1.0), GGX, "uncorrelated", "Walk", 64, 0.05),
    ("sun", "CONDUCTOR", (1.0, 1.0), GGX, "tracked", "Walk", 64, 0.05),
    ("sun", "DIFFUSE", (1.0, 1.0), GGX, "correlated", "Single", 32, 0.035),
    ("sun", "DIFFUSE", (1.0, 1.0), GGX, "correlated", "Fitted", 32, 0.015),
    ("sun", "DIFFUSE", (0.3, 0.3), BECKMANN, "correlated", "Fitted", 32, 0.015),
    ("sun", "DIFFUSE", (1.0, 0.1), GGX, "correlated", "Walk", 32, 0.03),
    ("sun", "DIELECTRIC", (0.3, 0.3), GGX, "correlated", "Fitted", 32, 0.03),
    ("sun", "DIELECTRIC", (1.0, 1.0), BECKMANN, "correlated", "Fitted", 64, 0.04),
    ("back", "DIELECTRIC", (0.3, 0.3), GGX, "correlated", "Single", 64, 0.05),
    ("back", "DIELECTRIC", (0.3, 0.3), BECKMANN, "correlated", "Fitted", 64, 0.04),
    ("back", "DIELECTRIC", (1.0, 1.0), GGX, "tracked", "Walk", 96, 0.15),
    ("inside", "DIELECTRIC", (0.5, 0.5), GGX, "correlated", "Fitted", 96, 0.12),
    ("slab", "DIELECTRIC", (0.3, 0.3), GGX, "correlated", "Fitted", 32, 0.04),
    ("slab", "DIELECTRIC", (0.6, 0.6), GGX, "correlated", "Walk", 32, 0.05),
]

# A white furnace that loses nothing shows the world's radiance, 1.
FURNACES = [
    ("CONDUCTOR", (1.0, 1.0), GGX, "correlated", "Exact", False),
    ("CONDUCTOR", (1.0, 0.1), BECKMANN, "tracked", "Exact", False),
    ("DIFFUSE", (1.0, 1.0), BECKMANN, "correlated", "Exact", False),
    ("DIELECTRIC", (1.0, 1.0), GGX, "correlated", "Exact", False),
    ("DIELECTRIC", (0.5, 0.5), BECKMANN, "uncorrelated", "Exact", True),
    ("CONDUCTOR", (1.0, 1.0), BECKMANN, "correlated", "Fitted", False),
    ("DIFFUSE", (1.0, 1.0), GGX, "correlated", "Fitted", False),
    ("DIELECTRIC", (0.5, 0.5), GGX, "correlated", "Fitted", True),
]


def name(*parts: object) -> str:
    return "-".join(str(part) for part in parts)


@pytest.mark.parametrize(
    ("light", "kind", "alphas", "distribution", "model", "quality", "samples", "limit"),
    SUN,
    ids=[name(r[0], r[1].lower(), r[2][0], r[2][1], *r[3:6]) for r in SUN],
)
def test_light(light, kind, alphas, distribution, model, quality, samples, limit, report) -> None:
    case = Case(light, kind, Widths(*alphas), distribution, f"height-{model}")
    wanted = pictures.reference(case.reference)
    material = pictures.open_lit(light, kind)
    white = WHITE if kind == "CONDUCTOR" else {}
    pictures.set_values(material, {**white, **case.values, "Quality": quality})
    layer = wanted["single" if quality == "Single" else "mean"]
    a, b = pictures.independent_pictures(samples, 2)
    error, spread = pictures.unbiased_l2_error(a, b, layer, wanted["mask"])
    energy = pictures.energy_ratio(0.5 * (a + b), layer, wanted["mask"])
    value = f"{error:.2%} +- {spread:.2%}, energy {energy:.3f}"
    report(f"{quality}, {case.reference}", value, f"{limit:.1%}")
    assert error < limit
    assert abs(energy - 1.0) < limit


@pytest.mark.parametrize("reference", [*COLOURED, "sun_clay_ggx_1"])
def test_colour(reference: str, report) -> None:
    """Each channel of Fitted keeps its energy."""
    wanted = pictures.reference(reference)
    matte = reference not in COLOURED
    alpha = 1.0 if matte else 0.5
    values = {**(CLAY if matte else COLOURED[reference]), **Widths(alpha, alpha).inputs}
    scene = f"sphere_sun_{'diffuse' if matte else 'conductor'}"
    found = pictures.render_fixture(scene, 32, Quality="Fitted", **values)
    mask = wanted["mask"]
    ratios = found[mask].mean(axis=0) / wanted["mean"][mask].mean(axis=0)
    report(f"Fitted, {reference}: R, G, B", ", ".join(f"{r:.4f}" for r in ratios), "1 +- 0.01")
    assert np.abs(ratios - 1.0).max() < 0.01


@pytest.mark.parametrize(
    ("kind", "alphas", "distribution", "model", "quality", "inside"),
    FURNACES,
    ids=[name(r[0].lower(), *r[1], *r[2:5], "in" if r[5] else "out") for r in FURNACES],
)
def test_furnace(kind, alphas, distribution, model, quality, inside, report) -> None:
    material = pictures.open_scene(f"furnace_{kind.lower()}")
    fixtures.turn_inside_out(inside)
    exact = {"MaxBounces": 32, "Tolerance": 0.0} if quality == "Exact" else {}
    values = {"Distribution": distribution, "Model": f"height-{model}", "Quality": quality}
    pictures.set_values(material, {**values, **Widths(*alphas).inputs, **exact})
    mean = pictures.picture(8 if exact else 96)[MASK].mean()
    limit = 0.003 if exact else 0.01
    report(f"furnace, {quality}, {kind.lower()}, {alphas}", f"{mean:.4f}", f"1 +- {limit}")
    assert abs(mean - 1.0) < limit


def test_walk_without_further_bounces_is_single() -> None:
    """Bit by bit: no walk is made, so no light is added and no random number is spent."""
    metal = pictures.open_scene("sphere_sun_conductor")
    metal.set("Quality", "Single")
    single = pictures.picture(2)
    metal.set("Quality", "Walk")
    assert not np.array_equal(pictures.picture(2), single)
    metal.set("MaxBounces", 1)
    assert np.array_equal(pictures.picture(2), single)


@pytest.mark.parametrize("kind", ["conductor", "dielectric", "diffuse"])
def test_fitted_takes_walk_without_a_table(kind: str) -> None:
    """Bit by bit."""
    material = pictures.open_scene(f"sphere_sun_{kind}")
    pictures.set_values(material, {"Model": "height-tracked", "Quality": "Walk"})
    walk = pictures.picture(2)
    material.set("Quality", "Fitted")
    assert walk.max() > 0.0
    assert np.array_equal(pictures.picture(2), walk)
