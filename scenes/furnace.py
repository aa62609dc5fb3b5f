# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how much light lossless surfaces return, in furnace_conductor.blend."""

from collections.abc import Callable, Mapping
from pathlib import Path

import bpy
import numpy as np
from tqdm import tqdm

from . import render, variants

SCENE = Path(__file__).resolve().parent / "furnace_conductor.blend"
SIZE = 48
SAMPLES = 32
SURFACE = ("Roughness", "Anisotropy", "Rotation", "Distribution", "MaxBounces", "Tolerance")


# Switches materials to a variant.
Switch = Callable[[list[variants.Material]], None]


def energies(
    metals: list[variants.Material], switches: Mapping[str, Switch], log: Path
) -> dict[str, list[float]]:
    """Return, by the keys of `switches`, the mean radiance of white spheres like the metals.

    The mean is over the sphere's picture, so angles of view count by their projected area. Opens
    the furnace in place of the current file. `metals` are invalid afterwards.
    """
    surfaces = [{name: metal.get(name) for name in SURFACE} for metal in metals]
    with render.messages_to(log):
        bpy.ops.wm.open_mainfile(filepath=str(SCENE))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    white = variants.find_materials()
    found: dict[str, list[float]] = {key: [] for key in switches}
    work = log.with_name("furnace.exr")
    steps = tqdm(total=len(surfaces) * len(switches), desc="Furnace", unit="sphere")
    for surface in surfaces:
        for name, value in surface.items():
            white[0].set(name, value)
        for key, switch in switches.items():
            switch(white)
            passes, _ = render.render_passes(work, SAMPLES, 0, log)
            found[key].append(float(np.mean(render.combined(passes)[_inside(scene)])))
            steps.update()
    steps.close()
    work.unlink()
    return found


def _inside(scene: bpy.types.Scene) -> np.ndarray:
    """Return the mask (SIZE, SIZE) of pixels that lie wholly on the unit sphere."""
    width = scene.camera.data.ortho_scale
    edges = np.abs((np.arange(SIZE) + 0.5) / SIZE - 0.5) * width + 0.5 * width / SIZE
    return edges[:, None] ** 2 + edges[None, :] ** 2 < 1.0
