# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a scene with a given number of samples and seed, and measures time and memory.

It changes the scene and its materials for good, so it is for a copy of the user's file.
"""

import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy

from ..core.cost.plan import Options, Variant, overridden
from ..material.group import has_bytecode
from ..material.variants import Placed, placed_in
from ..scene.usage import is_used, material_uses
from .page_pictures import read_picture
from .still import hold_still

# "Mem:0.50M, Peak:1.25M" up to Blender 4.5, "Mem: 11M" in Blender 5.
_PEAK = re.compile(r"Peak:\s*([\d.]+)([KMG])")
_MEMORY = re.compile(r"Mem:\s*([\d.]+)([KMG])")
_SAMPLES = re.compile(r"Sample (\d+)/")
_MEGABYTES = {"K": 1 / 1024, "M": 1.0, "G": 1024.0}


@dataclass(frozen=True)
class Rendered:
    """A picture, linear radiance (height, width, 3), with its time and memory.

    wall, processor -- seconds of the whole render, by the clock and of all threads together
    memory          -- Cycles' own count of its peak in megabytes, 0 if it gives none
    """

    picture: "numpy.ndarray"
    wall: float
    processor: float
    memory: float


class Renderer:
    """A scene that is made ready for measuring.

    samples -- of a picture
    held    -- the labels of the inputs whose keyframes and drivers were stopped
    """

    def __init__(self, scene: bpy.types.Scene, layer: str, options: Options, folder: Path) -> None:
        """Make the scene ready; `layer` is the view layer to render, `folder` takes pictures."""
        self._scene = scene
        self._path = folder / "picture.exr"
        self._placed = placed_nodes()
        self._kept: list[tuple] = []
        self.samples = options.samples or max(2, scene.cycles.samples)
        # Before animation is stopped, every input takes its value at this frame.
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        self.held = hold_still(self._placed, overridden(options))
        _prepare(scene, layer, options)
        _prepare_output(scene.render, self._path)

    def show(self, variant: Variant) -> None:
        """Switch the materials to a variant."""
        self._put_back()
        for placed in self._placed:
            for identifier, value in variant.settings.items():
                socket = placed.node.inputs[placed.kind.by_identifier[identifier].label]
                source = socket.links[0].from_socket if socket.is_linked else None
                self._kept.append((placed, identifier, placed.get(identifier), source))
                placed.set(identifier, value)
            if variant.native:
                placed.show_cycles()
            else:
                placed.show_ours()
        self._scene.cycles.shading_system = variant.osl

    def render(
        self, samples: int, seed: int, tell: Callable[[int], None] = lambda done: None
    ) -> Rendered:
        """Render. `tell` gets the number of samples that are done whenever Cycles reports it.

        Raises RuntimeError if no picture comes out.
        """
        cycles = self._scene.cycles
        cycles.seed = seed
        # Cycles puts the first sample of every seed into the middle of the pixel. That is a bias of
        # 1 / samples, so it is left out.
        cycles.samples, cycles.sample_subset_length = samples + 1, samples
        self._path.unlink(missing_ok=True)
        with _listening(tell) as told:
            wall, processor = time.perf_counter(), time.process_time()
            bpy.ops.render.render(write_still=True, scene=self._scene.name)
            processor = time.process_time() - processor
            wall = time.perf_counter() - wall
        if not self._path.is_file():
            raise RuntimeError("Blender wrote no picture: is there room for temporary files?")
        return Rendered(read_picture(self._path), wall, processor, max(told, default=0.0))

    def _put_back(self) -> None:
        while self._kept:
            placed, identifier, value, source = self._kept.pop()
            socket = placed.node.inputs[placed.kind.by_identifier[identifier].label]
            socket.default_value = value
            if source is not None:
                placed.tree.links.new(source, socket)


def placed_nodes() -> list[Placed]:
    """Return the nodes of our groups in all materials that the file uses.

    Raises RuntimeError if there is none, or if one holds no compiled shader.
    """
    found: dict[tuple[bpy.types.NodeTree, str], Placed] = {}
    for use in material_uses():
        if is_used(use.material):
            found |= {(p.tree, p.name): p for p in placed_in(list(use.trees))}
    if not found:
        raise RuntimeError("The file uses no Microbounce material: give one to an object")
    for placed in found.values():
        if not has_bytecode(placed.node.node_tree):
            raise RuntimeError(
                f"The node group '{placed.node.node_tree.name}' holds no compiled shader: add its "
                "material anew in a Blender with Open Shading Language"
            )
    return list(found.values())


def _prepare(scene: bpy.types.Scene, layer: str, options: Options) -> None:
    """Switch off what biases pixels, changes the number of samples, or draws over the picture.

    Clamping stays as the user set it, because without it a few bright pixels may hide all else.
    """
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    for view_layer in scene.view_layers:
        view_layer.use = view_layer.name == layer
    if options.percentage:
        render.resolution_percentage = options.percentage
    if options.region is not None:
        render.use_border = True
        render.border_min_x, render.border_min_y = options.region[:2]
        render.border_max_x, render.border_max_y = options.region[2:]
    render.use_crop_to_border = True
    render.use_multiview = render.use_stamp = render.use_freestyle = False
    render.use_compositing = render.use_sequencer = False
    # Otherwise Cycles would not notice a change of samples.
    render.use_persistent_data = False
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_animated_seed = False
    cycles.use_guiding = False
    cycles.light_sampling_threshold = 0.0
    cycles.time_limit = 0.0
    cycles.use_layer_samples = "IGNORE"
    cycles.use_sample_subset, cycles.sample_offset = True, 1


def _prepare_output(render: bpy.types.RenderSettings, path: Path) -> None:
    settings = render.image_settings
    if hasattr(settings, "media_type"):  # from Blender 5 on; a video has no EXR
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    settings.exr_codec = "ZIP"
    settings.color_management = "FOLLOW_SCENE"
    render.filepath = str(path)


@contextmanager
def _listening(tell: Callable[[int], None]) -> Iterator[list[float]]:
    """Pass on the samples that Cycles reports; yield a list that collects the megabytes."""
    told: list[float] = []

    def listen(text: str) -> None:
        found = _PEAK.search(text) or _MEMORY.search(text)
        if found:
            told.append(float(found[1]) * _MEGABYTES[found[2]])
        samples = _SAMPLES.search(text)
        if samples:
            tell(int(samples[1]))

    bpy.app.handlers.render_stats.append(listen)
    try:
        yield told
    finally:
        bpy.app.handlers.render_stats.remove(listen)
