# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounce Only: each bounce alone keeps the energy that the oracle says leaves at it."""

import numpy as np
import pytest

from osl.oracle import Conductor, Dielectric, Diffuse, Surface, energies, sphere
from osl.oracle.surface import CORRELATED, GGX, HEIGHT_TRACKED, UNCORRELATED
from scenes import pictures
from scenes.pictures import Widths

pytestmark = pytest.mark.nightly

MATERIALS = {"CONDUCTOR": Conductor(), "DIELECTRIC": Dielectric(1.5), "DIFFUSE": Diffuse()}
MODELS = {
    "height-correlated": CORRELATED,
    "height-uncorrelated": UNCORRELATED,
    "height-tracked": HEIGHT_TRACKED,
}
BOUNCES = (1, 2, 3)
# By quality: samples, and the limit, that of the furnace; the noise of a picture's mean at these
# samples and of the oracle is below 0.001.
PROMISES = {"Exact": (192, 0.003), "Walk": (32, 0.01)}
ROUGH = Widths(1.0, 1.0)


@pytest.mark.parametrize("quality", PROMISES)
@pytest.mark.parametrize(
    ("kind", "model"),
    [
        *((kind, "height-correlated") for kind in MATERIALS),
        *(("DIELECTRIC", model) for model in ("height-uncorrelated", "height-tracked")),
    ],
)
def test_each_bounce_has_its_energy(kind: str, model: str, quality: str, report) -> None:
    """GGX, alpha 1, mean over the sphere in the furnace."""
    view = sphere.view(subsamples=1)
    wi = np.concatenate([view.row(row)[0][:, 0] for row in range(len(view.mask))])
    surface = Surface(1.0, 1.0, GGX, MATERIALS[kind], MODELS[model])
    wanted = energies(wi, surface, max(BOUNCES), 400, 1).both.mean[..., 0].mean(axis=1)
    samples, limit = PROMISES[quality]
    material = pictures.open_scene(f"furnace_{kind.lower()}")
    pictures.set_values(material, {"Quality": quality, "Model": model, **ROUGH.inputs})
    found = []
    for bounce in BOUNCES:
        material.set("BounceOnly", bounce)
        found.append(pictures.picture(samples)[view.mask].mean())
    report(
        f"bounces 1, 2, 3 of {kind.lower()}, {model}, {quality}",
        ", ".join(f"{a:.4f} ({b:.4f})" for a, b in zip(found, wanted, strict=True)),
        f"+- {limit}",
    )
    assert np.abs(found - wanted).max() < limit


@pytest.mark.parametrize("kind", MATERIALS)
def test_bounce_one_of_walk_is_single(kind: str) -> None:
    """Bit by bit."""
    material = pictures.open_scene(f"sphere_sun_{kind.lower()}")
    pictures.set_values(material, {"Quality": "Single", **ROUGH.inputs})
    single = pictures.picture(4)
    pictures.set_values(material, {"Quality": "Walk", "BounceOnly": 1})
    assert np.array_equal(pictures.picture(4), single)
