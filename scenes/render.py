# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the open scene to linear EXR, reads it back, and applies the view transform."""

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
import OpenImageIO as oiio

# Blender 5 gave passes longer names.
_RENAMED = {"Object Index.X": "IndexOB.X"}


def render_passes(path: Path, samples: int, seed: int, log: Path) -> tuple[dict, float]:
    """Render the scene into a multilayer float EXR at `path`.

    Returns the passes by channel name, and the seconds that the render took. A pass is float32
    (height, width) from the top row down. Names have no layer, such as "Combined.R". Blender 5's
    "Object Index.X" is "IndexOB.X" as in Blender 4.
    Blender's own messages are appended to `log`. Raises RuntimeError if no picture came out.
    """
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = samples, seed
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # Blender 5
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER"
    settings.color_depth = "32"
    scene.render.filepath = str(path)
    path.unlink(missing_ok=True)
    with messages_to(log):
        begin = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        seconds = time.perf_counter() - begin
    if not path.is_file():
        raise RuntimeError(f"Blender wrote no {path.name}; its messages are in {log}")
    return read_passes(path), seconds


def read_passes(path: Path) -> dict:
    """Return the passes of a multilayer EXR as render_passes() does. Raises RuntimeError."""
    passes = {}
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise RuntimeError(f"{path} cannot be read: {oiio.geterror()}")
    part = 0
    while source.seek_subimage(part, 0):
        names = source.spec().channelnames
        pixels = source.read_image(part, 0, 0, len(names), oiio.FLOAT)
        for index, name in enumerate(names):
            key = ".".join(name.split(".")[-2:])
            passes[_RENAMED.get(key, key)] = pixels[..., index]
        part += 1
    source.close()
    return passes


def combined(passes: dict) -> np.ndarray:
    """Return the linear radiance of the picture, float32 (height, width, 3)."""
    return np.stack([passes[f"Combined.{channel}"] for channel in "RGB"], axis=-1)


def write_image(path: Path, pixels: np.ndarray, spec: oiio.ImageSpec) -> None:
    """Write pixels (height, width, channels) as in `spec`. Raises RuntimeError on failure."""
    target = oiio.ImageBuf(spec)
    target.set_pixels(spec.roi, np.ascontiguousarray(pixels, dtype=np.float32))
    if not target.write(str(path)):
        raise RuntimeError(f"{path} cannot be written: {target.geterror()}")


def write_display(exr: Path, radiance: np.ndarray) -> np.ndarray:
    """Write linear radiance (height, width, 3) as half-float EXR and as PNG beside it.

    The PNG goes through the scene's view transform. Returns its pixels, float32 (height, width, 3).
    """
    spec = oiio.ImageSpec(radiance.shape[1], radiance.shape[0], 3, oiio.HALF)
    spec.attribute("compression", "zip")
    write_image(exr, radiance, spec)
    png = str(exr.with_suffix(".png"))
    scene = bpy.context.scene
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "8"
    image = bpy.data.images.load(str(exr), check_existing=False)
    try:
        image.save_render(png, scene=scene)
    finally:
        bpy.data.images.remove(image)
    return oiio.ImageBuf(png).get_pixels(oiio.FLOAT)[..., :3]


@contextmanager
def messages_to(log: Path) -> Iterator[None]:
    """Send Blender's own messages from standard output to the end of `log`."""
    sys.stdout.flush()
    kept = os.dup(1)
    target = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    try:
        os.dup2(target, 1)
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
        os.close(target)
