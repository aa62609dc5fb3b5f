# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a .blend file small, in a Blender that `proof.py` starts."""

import bpy

SIZE = 64  # pixels of the longer side
SAMPLES = 16


def run(blend: str, target: str, extension: str) -> None:
    """Write the pixels of the file's active scene to `target`, as float32.

    With `extension` "with" the extension is registered and compiles the shaders again. With
    "without" it is not registered, so the file is on its own.
    """
    bpy.ops.wm.open_mainfile(filepath=blend, load_ui=False, use_scripts=False)
    if extension == "with":
        _compile_anew()
    picture = f"{target}.exr"
    _make_small(bpy.context.scene, picture)
    bpy.ops.render.render(write_still=True)
    pixels(picture).tofile(target)


def pixels(picture: str) -> "numpy.ndarray":
    """Return the RGBA values of a picture file as a flat array."""
    import numpy

    image = bpy.data.images.load(picture)
    values = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(values)
    return values


def _compile_anew() -> None:
    from ..registration import register
    from .recompile import compile_anew

    register()
    compile_anew()


def _make_small(scene: bpy.types.Scene, picture: str) -> None:
    render = scene.render
    scale = SIZE / max(render.resolution_x, render.resolution_y)
    # Blender renders no fewer than 4 rows.
    render.resolution_x = max(4, round(render.resolution_x * scale))
    render.resolution_y = max(4, round(render.resolution_y * scale))
    render.resolution_percentage = 100
    # Compositor and sequencer would write files, and show other things than the materials.
    render.use_border = render.use_multiview = False
    render.use_compositing = render.use_sequencer = False
    render.filepath = picture
    settings = render.image_settings
    if hasattr(settings, "media_type"):  # from Blender 5 on; a video has no EXR
        settings.media_type = "IMAGE"
    settings.file_format = "OPEN_EXR"
    settings.color_depth = "32"
    cycles = getattr(scene, "cycles", None)
    if cycles is not None:
        cycles.samples, cycles.seed, cycles.time_limit = SAMPLES, 0, 0
        cycles.use_layer_samples = "IGNORE"
        cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_animated_seed = False
