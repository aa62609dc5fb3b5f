# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders one round of a variant, level by level, and measures its times and errors.

A round renders its samples in pieces: the first, the second, the next two, the next four and so on.
All pieces are of one sequence (Cycles' sample subset). Their sums are the pictures at 1, 2, 4 ...
samples, at the cost of the largest. Each round has its own seed.
"""

import statistics
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

from scenes import pictures, render

from .errors import resolution, squared_error
from .machine import this_machine
from .plan import Scene, Variant, levels
from .stage import open_stage, picture_mask, reference_variant, switch_to
from .store import Result

# The seeds of a reference. No round has them.
_REFERENCE_SEEDS = (1000, 1001)


class Measure:
    """An open scene of the plan."""

    def __init__(self, scene: Scene, log: Path) -> None:
        self.scene = scene
        self.log = log
        with render.messages_to(log):
            self.materials = open_stage(scene)
        self._camera_x = bpy.context.scene.camera.location.x

    def reference(self) -> Result:
        """A reference as errors.py describes it, with its ``resolution`` and the machine's fields.

        Raises OSError if a reference picture of the oracle is missing.
        """
        machine = {key: np.array(value) for key, value in this_machine().as_dict().items()}
        name = self.scene.reference
        if name == "render":
            self._switch(reference_variant())
            _, passes = self._picture(_REFERENCE_SEEDS[0], 0, 1, 1)
            first, second = (self._whole(seed) for seed in _REFERENCE_SEEDS)
            made = {"first": first, "second": second, "mask": picture_mask(passes)}
            return {**made, "resolution": np.array(resolution(made)), **machine}
        if not name:
            _, passes = self._picture(0, 0, 1, 1)
            return {"mask": picture_mask(passes), **machine}
        # In a white world, a surface that loses no light shows exactly 1.
        white = name == "white"
        found = pictures.reference("furnace_clay_ggx_1" if white else name)
        mean, error = found["mean"], found["error"]
        if white:
            mean, error = np.ones_like(mean), np.zeros_like(error)
        mean = mean.astype(np.float32)
        made = {"first": mean, "second": mean, "mask": found["mask"]}
        others = {
            variant: pictures.reference(file)["mean"].astype(np.float32)
            for variant, file in self.scene.others
        }
        return {**made, **others, "resolution": np.array(resolution(made, error)), **machine}

    def run(self, variant: Variant, turn: int, reference: Result) -> Result:
        """One round of a variant.

        ``samples``, ``squared_error`` -- arrays over the levels, as in Curve
        ``cpu``, ``wall``   -- processor and passed seconds of a sample
        ``start``   -- processor seconds of the first render, which compiles the shaders
        ``piece``   -- processor seconds of a render apart from its samples
        ``picture`` -- the picture at ``scene.paired`` samples, if the round has as many
        """
        top = self.scene.tops[turn]
        self._switch(variant)
        begin = time.process_time()
        self._picture(turn, 0, 1, top)  # warm-up
        start = time.process_time() - begin
        total = 0.0
        found, errors, times, kept = levels(top), [], [], {}
        for level, before in zip(found, [0, *found], strict=False):
            count = level - before
            cpu, wall = time.process_time(), time.perf_counter()
            picture, _ = self._picture(turn, before, count, top)
            times.append((time.process_time() - cpu, time.perf_counter() - wall, count))
            total = total + count * picture
            errors.append(squared_error(total / level, reference, variant.name))
            if level == self.scene.paired:
                kept["picture"] = (total / level).astype(np.float32)
        cpu, piece = split_times([(cpu, count) for cpu, _, count in times])
        wall, _ = split_times([(wall, count) for _, wall, count in times])
        return {
            "samples": np.array(found),
            "squared_error": np.array(errors),
            "cpu": np.array(cpu),
            "wall": np.array(wall),
            "start": np.array(start),
            "piece": np.array(piece),
            **kept,
        }

    def _switch(self, variant: Variant) -> None:
        switch_to(self.scene, variant, self.materials)

    def _whole(self, seed: int) -> np.ndarray:
        """A reference's picture."""
        samples = self.scene.reference_samples
        return self._picture(seed, 0, samples, samples)[0].astype(np.float32)

    def _picture(self, seed: int, first: int, count: int, top: int) -> tuple[np.ndarray, dict]:
        """Render `count` samples from `first` on of a sequence of `top`.

        Returns the picture (rows, columns, 3) and all passes. The camera moves aside with the seed,
        by less than a thousandth of a pixel. The shader draws its random numbers from the place it
        shades, so they change too.
        """
        scene = bpy.context.scene
        cycles = scene.cycles
        cycles.use_sample_subset = True
        cycles.sample_offset, cycles.sample_subset_length = first, count
        scene.camera.location.x = self._camera_x + seed % 100 * pictures.NUDGE
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "picture.exr")
            passes, _ = render.render_passes(path, top, seed, self.log)
        return render.combined(passes).astype(np.float64), passes


def split_times(times: list[tuple[float, int]]) -> tuple[float, float]:
    """Seconds of a sample, and of a piece apart from its samples, from (seconds, samples) of each.

    The last piece is the largest. Its extra samples explain its extra time over a single sample.
    """
    seconds, count = times[-1]
    single = statistics.median([one for one, many in times if many == 1])
    if count < 2:
        return seconds, 0.0
    a_sample = max((seconds - single) / (count - 1), 1e-9)
    return a_sample, max(single - a_sample, 0.0)
