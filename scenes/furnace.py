# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how much light lossless surfaces return, in furnace_conductor.blend."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np
from tqdm import tqdm

from . import render, variants

if TYPE_CHECKING:
    from .demo import Variant

SCENE = Path(__file__).resolve().parent / "furnace_conductor.blend"
SIZE = 48
SAMPLES = 32
SURFACE = ("Roughness", "Anisotropy", "Rotation", "Distribution", "MaxBounces", "Tolerance")


def energies(metals: list[variants.Material], compared: "list[Variant]", log: Path) -> dict:
    """Return, by variant key, the mean radiance of a white sphere with each metal's surface.

    The mean is over the sphere's picture, so angles of view count by their projected area. Opens
    the furnace in place of the current file. `metals` are invalid afterwards.
    """
    surfaces = [{name: metal.get(name) for name in SURFACE} for metal in metals]
    with render.messages_to(log):
        bpy.ops.wm.open_mainfile(filepath=str(SCENE))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    white = variants.find_materials()
    found: dict[str, list[float]] = {variant.key: [] for variant in compared}
    work = log.with_name("furnace.exr")
    steps = tqdm(total=len(surfaces) * len(compared), desc="Furnace", unit="sphere")
    for surface in surfaces:
        for name, value in surface.items():
            white[0].set(name, value)
        for variant in compared:
            variant.apply(white)
            passes, _ = render.render_passes(work, SAMPLES, 0, log)
            found[variant.key].append(float(np.mean(render.combined(passes)[_inside(scene)])))
            steps.update()
    steps.close()
    work.unlink()
    return found


def _inside(scene: bpy.types.Scene) -> np.ndarray:
    """Return the mask (SIZE, SIZE) of pixels that lie wholly on the unit sphere."""
    width = scene.camera.data.ortho_scale
    edges = np.abs((np.arange(SIZE) + 0.5) / SIZE - 0.5) * width + 0.5 * width / SIZE
    return edges[:, None] ** 2 + edges[None, :] ** 2 < 1.0
