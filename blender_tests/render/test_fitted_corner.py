# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted metal that light reaches by way of other metal: the corner of three squares.

Where the camera does not look the further bounces of isotropic metal are a cosine lobe and more of
the first bounce. What is to be shown is their energy and colour, and how near the picture is to
Exact's.
"""

import bpy
import numpy as np
import pytest
from mathutils import Vector

from scenes import common, pictures, variants
from scenes.pictures import WHITE, Widths

from .test_fitted_anisotropic import GOLD_INPUTS

pytestmark = pytest.mark.nightly

SIZE = 40
BOUNCES = 32  # between the squares
SURFACES = [("GGX", (0.5, 0.5)), ("GGX", (1, 1)), ("Beckmann", (1, 1)), ("GGX", (1, 0.1))]
LIMIT_OF_ENERGY = 0.005
# Of the picture under a wide sun, and of each channel's light: what is promised of a sphere, and
# 1 % for Exact's noise. 0.989 to 1.008 of the light was measured, of the anisotropic metal, which
# has all its closures here as well, 1.013 to 1.039.
LIMIT, LIMIT_OF_ANISOTROPIC = 0.03, 0.06

by_surface = pytest.mark.parametrize(("distribution", "alphas"), SURFACES)


@by_surface
def test_furnace(distribution: str, alphas: tuple[float, float], report) -> None:
    """White metal in a white world is not to be seen."""
    _open("furnace", distribution, alphas, "Fitted", WHITE)
    found = pictures.picture(512)
    blocks = pictures.block_means(found, np.ones(found.shape[:2], dtype=bool))
    name = f"corner in a white world, Fitted, {distribution} {Widths(*alphas).name}"
    value = f"{blocks.min():.4f} .. {blocks.max():.4f}, mean {found.mean():.4f}"
    report(name, value, f"mean 1 +- {LIMIT_OF_ENERGY}, each block {2 * LIMIT_OF_ENERGY}")
    assert abs(found.mean() - 1.0) < LIMIT_OF_ENERGY
    assert np.abs(blocks - 1.0).max() < 2 * LIMIT_OF_ENERGY


@by_surface
def test_gold_under_a_wide_sun(distribution: str, alphas: tuple[float, float], report) -> None:
    """Against Exact, whose paths meet a sun of one radian."""
    gold = _open("sphere_sun", distribution, alphas, "Exact", GOLD_INPUTS)
    bpy.data.objects["Sun"].data.angle = 1.0
    exact = pictures.independent_pictures(2048, 2)
    gold.set("Quality", "Fitted")
    fitted = pictures.independent_pictures(128, 2)
    lit = exact.mean(axis=(0, -1)) > 0.0
    # Both have noise: each product is of two pictures that share none.
    missed = (fitted[0] - exact[0])[lit] * (fitted[1] - exact[1])[lit]
    error = np.sqrt(max(missed.mean(), 0.0) / (exact[0] * exact[1])[lit].mean())
    ratios = fitted[:, lit].mean(axis=(0, 1)) / exact[:, lit].mean(axis=(0, 1))
    name = f"corner under a wide sun, Fitted gold, {distribution} {Widths(*alphas).name}"
    value = f"{error:.2%}; R, G, B: {', '.join(f'{r:.4f}' for r in ratios)}"
    limit = LIMIT if alphas[0] == alphas[1] else LIMIT_OF_ANISOTROPIC
    report(name, value, f"{limit:.0%}, 1 +- {limit}")
    assert error < limit
    assert np.abs(ratios - 1.0).max() < limit


def _open(
    scene: str,
    distribution: str,
    alphas: tuple[float, float],
    quality: str,
    values: dict[str, object],
) -> variants.Material:
    """Open a fixture with the corner in place of its sphere, seen along its diagonal."""
    metal = pictures.open_scene(f"{scene}_conductor")
    values = {**values, **Widths(*alphas).inputs, "MaxBounces": 32, "Quality": quality}
    pictures.set_values(metal, {**values, "Distribution": distribution})
    bpy.data.objects.remove(bpy.data.objects["Sphere"])
    mesh = bpy.data.meshes.new("Corner")
    axes = np.eye(3)
    squares = [
        corner
        for a, b in zip(axes, np.roll(axes, 1, axis=0), strict=True)
        for corner in (0 * a, a, a + b, b)
    ]
    mesh.from_pydata(squares, [], [range(i, i + 4) for i in range(0, len(squares), 4)])
    mesh.materials.append(metal.material)
    corner = common.add_object("Corner", mesh)
    to_camera = Vector((0.0, -1.0, 0.0))
    corner.rotation_euler = Vector((1.0, 1.0, 1.0)).rotation_difference(to_camera).to_euler()
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    for kind in ("max", "glossy", "diffuse"):
        setattr(scene.cycles, f"{kind}_bounces", BOUNCES)
    return metal
