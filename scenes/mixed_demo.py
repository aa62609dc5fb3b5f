# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what the analysis saves: renders a scene of mixed materials all in Walk, all in Fitted and
as analysed, and prints time and measured error beside what was predicted.

The error is that of the converged pictures against Exact, which has no bias: of two independent
renders of each, so that their noise cancels in the mean.
"""

import argparse
import os
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np

from addon.core.analysis import Choice, predicted_error
from addon.core.picture_error import DEFAULT_TOLERANCE, picture_error
from addon.nodes.analyse import Report, analyse
from addon.nodes.inspect import apply_choice, found_nodes, read_surface
from addon.nodes.share import shown_materials
from tools.timing import SampleTimes, time_samples

from . import mixed, render

ANALYSED = "Analysed"
VARIANTS = ("Walk", "Fitted", ANALYSED)
_ALL_BOUNCES = 16
# A render's camera is moved aside by this from one seed to the next, less than a thousandth of a
# pixel: Cycles places some samples of two seeds alike.
_NUDGE = 1e-5


class Scene:
    """The open scene's materials, which can be switched to a quality or to what was analysed."""

    def __init__(self, tolerance: float) -> None:
        self.report: Report = analyse(bpy.context, tolerance)
        self.found = found_nodes(shown_materials(bpy.context))
        self._proposals = {row.key: row.proposal for row in self.report.rows}

    def choices(self, variant: str) -> list[Choice]:
        """Return what a variant sets on each of `found`: a quality of all, or ANALYSED."""
        if variant == ANALYSED:
            return [self._proposals[one.key].then for one in self.found]
        return [Choice(variant, _ALL_BOUNCES)] * len(self.found)

    def switch(self, variant: str) -> None:
        """Set the variant."""
        for one, choice in zip(self.found, self.choices(variant), strict=True):
            apply_choice(one, choice)

    def predicted(self, variant: str) -> float:
        """Return the error that the analysis predicts for a variant."""
        return picture_error(
            [
                (self._proposals[one.key].share, predicted_error(read_surface(one)[0], choice))
                for one, choice in zip(self.found, self.choices(variant), strict=True)
            ]
        )

    def pictures(self, variant: str, samples: int, first_seed: int) -> np.ndarray:
        """Return two independent renders of a variant, ``(2, rows, columns, 3)``."""
        self.switch(variant)
        camera = bpy.context.scene.camera
        start = camera.location.x
        found = []
        with TemporaryDirectory() as folder:
            for number in range(2):
                camera.location.x = start + number * _NUDGE
                path, log = Path(folder, "picture.exr"), Path(folder, "log")
                passes, _ = render.render_passes(path, samples, first_seed + number, log)
                found.append(render.combined(passes).astype(np.float64))
        camera.location.x = start
        return np.array(found)


def difference(found: np.ndarray, wanted: np.ndarray) -> tuple[float, float]:
    """Return the error of what two pairs of pictures ``(2, rows, columns, 3)`` converge to, as
    image L2 over the second one's, and its standard error."""
    product = ((found[0] - wanted[0]) * (found[1] - wanted[1])).mean(axis=-1).ravel()
    power = float((wanted[0] * wanted[1]).mean())
    squared = product.mean() / power
    spread = product.std(ddof=1) / np.sqrt(product.size) / power
    error = np.sqrt(max(squared, 0.0))
    return float(error), float(0.5 * spread / max(error, np.sqrt(spread)))


def print_result(scene: Scene, errors: dict[str, tuple[float, float]], times: SampleTimes) -> None:
    """Print the table of the materials, and times and errors."""
    print(f"\n{'':18}{'share':>8}  {'proposed':18}{'off by':>8}  reason")
    for row in scene.report.rows:
        one = row.proposal
        print(f"{row.name:18}{one.share:8.1%}  {one.then!s:18}{one.error_then:8.2%}  {one.reason}")
    print(
        f"\n{'':12}{'a sample':>10}{'over Walk':>12}{'start':>10}"
        f"{'error measured':>18}{'predicted':>12}"
    )
    for variant in VARIANTS:
        error, spread = errors[variant]
        measured = f"{100 * error:.2f} +- {100 * spread:.2f} %"
        print(
            f"{variant:12}{1000 * times.median(variant):7.0f} ms"
            f"{times.ratio(variant, 'Walk'):12.2f}{times.start(variant):8.1f} s"
            f"{measured:>18}{scene.predicted(variant):12.2%}"
        )
    print(f"Predicted time over Walk: {scene.report.time_ratio:.2f}")


def main() -> None:
    """Parse the arguments, measure and print."""
    parser = argparse.ArgumentParser(prog="python -m scenes.mixed_demo", description=__doc__)
    parser.add_argument("--tolerance", type=float, default=DEFAULT_TOLERANCE)
    parser.add_argument("--samples", type=int, default=96, help="a pixel (%(default)s)")
    parser.add_argument("--rounds", type=int, default=3, help="of timing (%(default)s)")
    parser.add_argument("--save", type=Path, metavar="FILE", help="also save the scene as .blend")
    arguments = parser.parse_args()
    begin = time.perf_counter()

    def tell(text: str) -> None:
        print(f"{time.perf_counter() - begin:5.0f} s  {text}", flush=True)

    mixed.build()
    Scene(arguments.tolerance).switch("Walk")
    scene = Scene(arguments.tolerance)  # of materials that are all in Walk
    tell("rendering the reference, Exact")
    wanted = scene.pictures("Exact", 8 * arguments.samples, first_seed=100)
    errors = {}
    for variant in VARIANTS:
        tell(f"rendering {variant}")
        found = scene.pictures(variant, arguments.samples, first_seed=0)
        errors[variant] = difference(found, wanted)
    tell("timing")
    switches = {variant: lambda v=variant: scene.switch(v) for variant in VARIANTS}
    with TemporaryDirectory() as folder, render.messages_to(Path(folder, "log")):
        times = time_samples(bpy.context.scene, switches, samples=24, rounds=arguments.rounds)
    print_result(scene, errors, times)
    tell("in all; processor time")
    if arguments.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(arguments.save.resolve()))


if __name__ == "__main__":
    main()
    # bpy 4.5 was seen to hang while it takes itself down.
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
