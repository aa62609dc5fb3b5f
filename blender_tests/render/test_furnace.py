# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnace: a surface that loses nothing, in a uniform world of radiance 1, shows radiance 1.

That is the analytic answer for every alpha and index, from outside and from inside: each path
leaves in the end, whichever way it goes, and meets the same radiance (across glass, the same energy
of it; Cycles does not scale radiance with the index).
"""

import bpy
import numpy as np
import pytest

from osl.oracle.sphere import sphere_points
from scenes import fixtures, pictures, variants
from scenes.pictures import Widths

pytestmark = pytest.mark.nightly

SIZE = 40
MASK = sphere_points(SIZE, 1)[1]
ROUGH = Widths(1.0, 1.0)
WIDTHS = [*(Widths(a, a) for a in (0.01, 0.25, 0.5)), ROUGH, Widths(1.0, 0.1)]
DISTRIBUTIONS = ("GGX", "Beckmann")
KINDS = ("CONDUCTOR", "DIELECTRIC", "DIFFUSE")
# 32 bounces leave less than 1e-9 of any case, and no tolerance is asked for.
ALL = {"MaxBounces": 32, "Tolerance": 0.0}
# What the product promises, and the samples at which a block's noise is below a quarter of it. In
# Exact all paths have weight 1, so that there is none.
PROMISES = {"Exact": 0.003, "Fitted": 0.003, "Walk": 0.01}
SAMPLES = {"Exact": 8, "Fitted": 1024, "Walk": 128}
SAMPLES_OF_ROUGHEST = {"Exact": 8, "Fitted": 1536, "Walk": 384}
# Inside glass, where facets near the critical angle reflect far more than a flat surface, Cycles
# samples its own reflection too seldom.
SAMPLES_INSIDE = {"Exact": 8, "Walk": 1024}

by_quality = pytest.mark.parametrize("quality", ["Exact", "Walk"])
by_distribution = pytest.mark.parametrize("distribution", DISTRIBUTIONS)
by_widths = pytest.mark.parametrize("widths", WIDTHS, ids=lambda widths: widths.name)
by_side = pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])


@by_quality
@by_distribution
@by_widths
@pytest.mark.parametrize("kind", ["CONDUCTOR", "DIFFUSE"])
def test_opaque(kind: str, quality: str, distribution: str, widths: Widths, report) -> None:
    """Metal and matte surfaces."""
    name = f"{kind.lower()}, {distribution} {widths.name}"
    _hold(name, _open(kind), quality, report, Distribution=distribution, **widths.inputs)


@by_quality
@by_distribution
@by_widths
@by_side
def test_glass(inside: bool, quality: str, distribution: str, widths: Widths, report) -> None:
    """Index 1.5."""
    name = f"glass{', inside' * inside}, {distribution} {widths.name}"
    glass = _open("DIELECTRIC", inside)
    _hold(name, glass, quality, report, inside, Distribution=distribution, **widths.inputs)


@by_distribution
@pytest.mark.parametrize("alpha", [0.01, 0.1, 0.25, 0.5, 0.75, 1.0])
@pytest.mark.parametrize("kind", ["CONDUCTOR", "DIFFUSE"])
def test_opaque_fitted(kind: str, alpha: float, distribution: str, report) -> None:
    """Metal and matte surfaces, isotropic."""
    name = f"{kind.lower()}, {distribution} {alpha:g}"
    values = {"Distribution": distribution, **Widths(alpha, alpha).inputs}
    _hold(name, _open(kind), "Fitted", report, **values)


@by_side
@pytest.mark.parametrize("ior", [1.1, 2.4])
def test_exact_glass_of_other_indices(ior: float, inside: bool, report) -> None:
    """Every surface of WIDTHS."""
    glass = _open("DIELECTRIC", inside)
    for distribution in DISTRIBUTIONS:
        for widths in WIDTHS:
            name = f"glass of {ior}{', inside' * inside}, {distribution} {widths.name}"
            values = {"IOR": ior, "Distribution": distribution, **widths.inputs}
            _hold(name, glass, "Exact", report, **values)


@by_side
@pytest.mark.parametrize("widths", [Widths(0.5, 0.5), ROUGH], ids=lambda widths: widths.name)
@pytest.mark.parametrize("ior", [1.1, 2.4])
def test_walk_in_glass_of_other_indices(ior: float, inside: bool, widths: Widths, report) -> None:
    """GGX, where most light bounces more than once; inside glass of a low index more than the 16
    bounces that are the default."""
    name = f"glass of {ior}{', inside' * inside}, GGX {widths.name}"
    values = {"IOR": ior, "MaxBounces": 64, **widths.inputs}
    _hold(name, _open("DIELECTRIC", inside), "Walk", report, inside, **values)


@by_quality
@pytest.mark.parametrize("model", ["height-uncorrelated", "height-tracked"])
@pytest.mark.parametrize("kind", KINDS)
def test_other_models(kind: str, model: str, quality: str, report) -> None:
    """At alpha 1, where the models differ most."""
    name = f"{kind.lower()}, {model}, GGX 1"
    _hold(name, _open(kind), quality, report, Model=model, **ROUGH.inputs)


def _open(kind: str, inside: bool = False) -> variants.Material:
    material = pictures.open_scene(f"furnace_{kind.lower()}")
    render = bpy.context.scene.render
    render.resolution_x = render.resolution_y = SIZE
    fixtures.turn_inside_out(inside)
    return material


def _hold(
    name: str,
    material: variants.Material,
    quality: str,
    report,
    inside: bool = False,
    **values: object,
) -> None:
    """Every block, and the rim around them, where the view is most grazing, is 1 within the limit.

    A block or the rim is a mean of 64 pixels or more.
    """
    limit = PROMISES[quality]
    rough = SAMPLES_OF_ROUGHEST if values["Roughness"] == 1.0 else SAMPLES
    samples = (SAMPLES_INSIDE if inside else rough)[quality]
    exact = ALL if quality == "Exact" else {}
    pictures.set_values(material, {"Quality": quality, **values, **exact})
    found = pictures.picture(samples)
    blocks, rim = pictures.block_means(found, MASK), pictures.rim_mean(found, MASK)
    low, high = min(blocks.min(), rim.min()), max(blocks.max(), rim.max())
    value = f"{low:.4f} .. {high:.4f}, mean {found[MASK].mean():.4f}, rim {rim.mean():.4f}"
    report(f"furnace, {quality}, {name}", value, f"1 +- {limit}")
    assert low >= 1.0 - limit
    assert high <= 1.0 + limit


def test_coloured_exact_metal_is_the_oracle(report) -> None:
    """Gold, alpha 0.5: every colour channel of every block within the noise of both (z-test)."""
    gold = {"BaseColor": (0.95, 0.75, 0.35), "EdgeTint": (0.98, 0.95, 0.75)}
    _hold_to_the_oracle("furnace_gold_ggx_0.5", "CONDUCTOR", report, **gold, **WIDTHS[2].inputs)


def test_coloured_exact_diffuse_is_the_oracle(report) -> None:
    """The same of a matte surface, alpha 1."""
    clay = {"Color": (0.8, 0.5, 0.2)}
    _hold_to_the_oracle("furnace_clay_ggx_1", "DIFFUSE", report, **clay, **ROUGH.inputs)


def _hold_to_the_oracle(name: str, kind: str, report, **values: object) -> None:
    wanted = pictures.reference(name)
    scene = f"furnace_{kind.lower()}"
    found, variance = pictures.seeds(scene, 32, 8, Quality="Exact", **values, **ALL)
    z = pictures.block_z(found, variance, wanted["mean"], wanted["error"], wanted["mask"])
    report(f"{name}, Exact: largest |z|", f"{np.abs(z).max():.2f} of {z.size}", "4.5")
    # Student's t of 8 x 64 samples a block is nearly normal; 4.5 is exceeded once in 1000 runs.
    assert np.abs(z).max() < 4.5
    assert abs(z.mean()) < 4.5 / np.sqrt(z.size / 3)  # channels go together
