# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact under a sun wide enough to be hit: the light of glass goes where the oracle's walks go.

This ties the fixtures lit from behind, seen from inside and shining through the slab to the oracle
without any kernel, and so tells faults of scenes and references from those of lobes.
"""

import bpy
import numpy as np
import pytest

from osl.oracle import GGX, Dielectric, Surface, slab, sphere
from osl.oracle.view import View
from osl.oracle.walk import bounces
from scenes import pictures
from scenes.pictures import Widths

pytestmark = pytest.mark.nightly

SIZE = 32
ANGLE = 0.5  # rad across
SAMPLES = 1024
WALKS = 20  # a point
ROUGH = Widths(0.5, 0.5)
VIEWS = {
    "back": (sphere.view(SIZE, 8), sphere.BACK_SUN),
    "inside": (sphere.view(SIZE, 8, inside_out=True), sphere.BACK_SUN),
    "slab": (slab.view(SIZE, 8), slab.SUN),
}


@pytest.mark.parametrize("light", VIEWS)
def test_exact_glass(light: str, report) -> None:
    """Mean radiance of the picture (z-test; both are means of paths that hit or miss the sun)."""
    view, sun = VIEWS[light]
    wanted, error = _oracle(view, sun)
    material = pictures.open_lit(light, "DIELECTRIC")
    pictures.set_values(material, {"Quality": "Exact", "Tolerance": 0.0, **ROUGH.inputs})
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.max_bounces = 1
    bpy.data.objects["Sun"].data.angle = ANGLE
    found = pictures.picture(SAMPLES)[view.mask].mean()
    paths = SAMPLES * view.mask.sum()
    error = np.hypot(error, np.sqrt(found / paths * _radiance()))
    z = (found - wanted) / error
    name = f"{light}, Exact, sun of {ANGLE} rad"
    report(name, f"{found:.4f} for {wanted:.4f} +- {error / wanted:.2%}", "4 standard errors")
    assert error < 0.015 * wanted
    assert abs(z) < 4.0


def _radiance() -> float:
    """Of a sun of irradiance 1: Cycles' discs have the projected solid angle of their cone."""
    return 1.0 / (np.pi * np.sin(0.5 * ANGLE) ** 2)


def _oracle(view: View, sun: np.ndarray) -> tuple[float, float]:
    """Mean radiance over the picture, and its standard error, by walks that end in the sun."""
    surface = Surface(ROUGH.alpha_x, ROUGH.alpha_y, GGX, Dielectric(1.5))
    rng = np.random.default_rng(1)
    total = count = 0.0
    for row in np.flatnonzero(view.mask.any(axis=1)):
        wi, axes = view.row(row)
        start = np.repeat(wi.reshape(-1, 3), WALKS, axis=0)
        frame = np.stack([np.repeat(axis.reshape(-1, 3), WALKS, axis=0) for axis in axes])
        count += len(start)
        for step in bounces(start, surface, 16, rng):
            # components along the axes, summed: the direction in the world
            world = np.einsum("nk,knc->nc", step.direction, frame[:, step.walk])
            total += step.leaving[world @ sun > np.cos(0.5 * ANGLE), 0].sum()
    mean = total / count
    # leaving weights are at most 1, so hits and misses bound the variance
    return mean * _radiance(), np.sqrt(mean / count) * _radiance()
