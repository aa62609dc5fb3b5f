# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the README's picture: a metal, a glass and a clay, each in three variants.

They are one bounce, the best of Cycles, and Microbounce. The stage and its lights are the
showcase's. Light paths have Blender's default limits. The denoiser and adaptive sampling are off.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np
from tqdm import tqdm

from addon.material.node import new_material

from . import common, comparison, demo, render, shapes, variants
from .build_showcase import METALS, VASE
from .leave import leave

PICTURE = demo.ROOT / "docs" / "materials.jpg"
RESOLUTION = (330, 250)
QUALITY = 85  # of the JPEG
VARIANTS = (
    demo.Variant("single", "One bounce", "Single"),
    demo.Variant("cycles", "Cycles' best", "CYCLES"),
    demo.Variant("fitted", "Microbounce", "Fitted"),
)

# Blender's defaults for a new file.
DEFAULTS = {
    "max_bounces": 12,
    "diffuse_bounces": 4,
    "glossy_bounces": 4,
    "transmission_bounces": 12,
    "sample_clamp_indirect": 10.0,
    "blur_glossy": 1.0,
    "light_sampling_threshold": 0.01,
}

POT = [
    (0.0, 0.0),
    (0.42, 0.0),
    (0.46, 0.03),
    (0.66, 0.3),
    (0.78, 0.65),
    (0.76, 0.95),
    (0.62, 1.2),
    (0.5, 1.3),
    (0.5, 1.38),
    (0.62, 1.47),
    (0.64, 1.5),
    (0.61, 1.52),
    (0.46, 1.4),
    (0.44, 1.3),
    (0.5, 1.2),
]


def _vase() -> bpy.types.Object:
    return _lathed("Vase", VASE, 0.74)


def _pot() -> bpy.types.Object:
    return _lathed("Pot", POT, 1.15)


def _lathed(name: str, profile: list[shapes.Point], scale: float) -> bpy.types.Object:
    added = common.add_object(name, shapes.lathe(name, profile))
    added.modifiers.new("Smooth", "SUBSURF").render_levels = 2
    added.location = (-0.15, 0.35, 0.45)
    added.scale = (scale, scale, scale)
    return added


def _knot() -> bpy.types.Object:
    knot = shapes.torus_knot("Knot", turns=(2, 3), radii=(0.62, 0.3), thickness=0.2)
    added = common.add_object("Knot", knot)
    added.location, added.rotation_euler = (-0.15, 0.35, 1.42), (1.2, 0.0, 0.35)
    added.scale = (0.92, 0.92, 0.92)
    return added


@dataclass(frozen=True)
class Row:
    """A row of the picture.

    kind, values -- of the material; the values by identifier
    add_shape -- adds the row's object to the scene and returns it
    samples   -- per pixel
    about     -- the line under the row
    """

    kind: str
    values: dict[str, object]
    add_shape: Callable[[], bpy.types.Object]
    samples: int
    about: str


ROWS = (
    Row(
        "CONDUCTOR",
        METALS["Gold"] | {"Roughness": 0.9, "Anisotropy": 0.9, "Rotation": 0.25},
        _vase,
        96,
        "Brushed gold, Roughness 0.9, Anisotropy 0.9. "
        "Cycles' best: Metallic BSDF, Multiscatter GGX",
    ),
    Row(
        "DIELECTRIC",
        {"Roughness": 0.85},
        _knot,
        256,
        "Rough glass, Roughness 0.85. Cycles' best: Glass BSDF, Multiscatter GGX",
    ),
    Row(
        "DIFFUSE",
        {"Color": (0.8, 0.36, 0.2), "Roughness": 1.0},
        _pot,
        96,
        "Clay, Roughness 1. Cycles' best: Diffuse BSDF of the nearest roughness",
    ),
)


def open_stage() -> None:
    """Open the showcase without its metals, with the camera on the plinth."""
    bpy.ops.wm.open_mainfile(filepath=str(demo.SCENE))
    scene = bpy.context.scene
    for thing in [thing for thing in scene.objects if thing.pass_index]:
        bpy.data.objects.remove(thing)
    scene.render.resolution_x, scene.render.resolution_y = RESOLUTION
    for name, value in DEFAULTS.items():
        setattr(scene.cycles, name, value)
    for light in bpy.data.lights:
        light.size *= 2.5
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 6.0
    scene.camera.location = (-0.15, -7.5, 2.2)
    common.aim(scene.camera, (0.0, 7.85, -0.84))
    scene.camera.data.lens = 88.0


def render_row(row: Row, folder: Path, steps: tqdm) -> list[np.ndarray]:
    """Return a picture for each variant, display-referred, float32 (height, width, 3)."""
    shape = row.add_shape()
    shape.data.materials.append(new_material(row.kind, "Shown", **row.values))
    shown = variants.find_materials()
    pictures = []
    for variant in VARIANTS:
        steps.set_postfix_str(f"{row.about.partition(',')[0]}, {variant.title}")
        variant.apply(shown)
        exr = folder / "picture.exr"
        passes, _ = render.render_passes(exr, row.samples, 0, folder / "blender.log")
        pictures.append(render.write_display(exr, render.combined(passes)))
        steps.update()
    bpy.data.objects.remove(shape)
    return pictures


def main() -> None:
    """Render the rows and write the picture."""
    parser = argparse.ArgumentParser(prog="python -m scenes.materials_picture", description=__doc__)
    parser.add_argument("--output", type=Path, default=PICTURE, metavar="FILE")
    arguments = parser.parse_args()
    begin = time.perf_counter()
    strips = []
    steps = tqdm(total=len(ROWS) * len(VARIANTS), desc="Rendering", unit="picture")
    with TemporaryDirectory() as name:
        folder = Path(name)
        with render.messages_to(folder / "blender.log"):
            open_stage()
        titles = [variant.title for variant in VARIANTS]
        for row in ROWS:
            pictures = render_row(row, folder, steps)
            strips.append(comparison.side_by_side(pictures, titles, [[]] * 3, row.about))
    steps.close()
    comparison.write_jpeg(arguments.output, np.concatenate(strips), QUALITY)
    size = arguments.output.stat().st_size / 1024
    print(f"{arguments.output}: {size:.0f} KB, {time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
    leave()
