# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what the analysis saves, on mixed materials all in Walk, all in Fitted and as analysed.

Prints time and error, measured and predicted, and writes a picture. The error is that of the
converged pictures against Exact, which has no bias. Each is rendered twice, independently, so noise
cancels in the mean. The error is taken of blocks of a few pixels, which have less noise. A sphere
is several blocks wide.
"""

import argparse
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np

from addon.analysis.analyse import Analysis, analyse
from addon.analysis.surfaces import apply_choice, found_nodes, read_surface
from addon.core.analysis.picture_error import DEFAULT_TOLERANCE, percent, picture_error
from addon.core.analysis.prediction import (
    Choice,
    Surface,
    predicted_cost,
    predicted_error,
)
from addon.core.analysis.proposal import time_of
from addon.scene.share import shown_materials

from . import comparison, mixed, pictures, render
from .leave import leave
from .timing import SampleTimes, time_samples

ROOT = Path(__file__).resolve().parent.parent
PICTURE = ROOT / "build" / "analysis" / "comparison.png"
ANALYSED = "Analysed"
VARIANTS = ("Walk", "Fitted", ANALYSED)
_ALL_BOUNCES = 16
FOOTER = "A scene of mixed materials; errors are those of the converged pictures, as image L2"
_BLOCK = 5  # pixels on a side


class AnalysedScene:
    """The open scene's materials, which can switch to a quality or to the proposals."""

    def __init__(self, tolerance: float) -> None:
        self.report: Analysis = analyse(bpy.context, tolerance)
        self.found = found_nodes(shown_materials(bpy.context))
        self._proposals = {row.key: row.proposal for row in self.report.rows}

    def choices(self, variant: str) -> list[Choice]:
        """Return the choice of a variant for each of `found`."""
        if variant == ANALYSED:
            return [self._proposals[one.key].then for one in self.found]
        return [Choice(variant, _ALL_BOUNCES)] * len(self.found)

    def switch(self, variant: str) -> None:
        """Apply a variant to the materials."""
        for one, choice in zip(self.found, self.choices(variant), strict=True):
            apply_choice(one, choice)

    def predicted(self, variant: str) -> float:
        """Return the predicted error of a variant."""
        return picture_error(
            (share, predicted_error(surface, choice))
            for surface, share, choice in self._predictions(variant)
        )

    def predicted_time(self, variant: str) -> float:
        """Return the predicted time of a sample, in the units of predicted_cost()."""
        costs = [
            (share, predicted_cost(surface, choice))
            for surface, share, choice in self._predictions(variant)
        ]
        return time_of(costs, self.report.empty)

    def _predictions(self, variant: str) -> list[tuple[Surface, float, Choice]]:
        return [
            (read_surface(one)[0], self._proposals[one.key].share, choice)
            for one, choice in zip(self.found, self.choices(variant), strict=True)
        ]

    def pictures(self, variant: str, samples: int, first_seed: int) -> np.ndarray:
        """Return two independent renders of a variant, ``(2, rows, columns, 3)``."""
        self.switch(variant)
        return pictures.independent_pictures(samples, 2, first_seed)


def difference(found: np.ndarray, wanted: np.ndarray) -> tuple[float, float]:
    """Return the image L2 error of a converged picture over `wanted`'s, and its standard error.

    found, wanted -- two independent renders each, ``(2, rows, columns, 3)``
    """
    found, wanted = _blocks(found), _blocks(wanted)
    product = ((found[0] - wanted[0]) * (found[1] - wanted[1])).mean(axis=-1)
    return pictures.converged_error(product, (wanted[0] * wanted[1]).mean())


def _blocks(renders: np.ndarray) -> np.ndarray:
    count, rows, columns, channels = renders.shape
    rows, columns = rows // _BLOCK, columns // _BLOCK
    whole = renders[:, : rows * _BLOCK, : columns * _BLOCK]
    return whole.reshape(count, rows, _BLOCK, columns, _BLOCK, channels).mean(axis=(2, 4))


def print_result(
    scene: AnalysedScene, errors: dict[str, tuple[float, float]], times: SampleTimes
) -> None:
    """Print the materials, the table of times and errors, and a summary."""
    print(f"\n{'':18}{'share':>8}  {'proposed':18}{'off by':>8}  reason")
    for row in scene.report.rows:
        one = row.proposal
        print(f"{row.name:18}{one.share:8.1%}  {one.then!s:18}{one.error_then:8.2%}  {one.reason}")
    print(
        f"\n| {len(scene.found)} materials | a sample | over Walk | predicted | error | predicted |"
    )
    print("| --- | --- | --- | --- | --- | --- |")
    walk = scene.predicted_time("Walk")
    for variant in VARIANTS:
        error, spread = errors[variant]
        print(
            f"| {variant} | {1000 * times.median(variant):.0f} ms "
            f"| {times.ratio(variant, 'Walk'):.2f} | {scene.predicted_time(variant) / walk:.2f} "
            f"| {100 * error:.2f} ± {100 * spread:.2f} % | {100 * scene.predicted(variant):.2f} % |"
        )
    steps = [row.proposal.then.quality for row in scene.report.rows]
    counts = ", ".join(f"{steps.count(step)} {step}" for step in dict.fromkeys(steps))
    error, spread = errors[ANALYSED]
    print(
        f"\nAs analysed ({counts}) a sample takes {times.ratio(ANALYSED, 'Walk'):.2f} times as "
        f"long as all in Walk and {times.ratio(ANALYSED, 'Fitted'):.2f} times as long as all in "
        f"Fitted; the picture is {100 * error:.2f} ± {100 * spread:.2f} % off, of "
        f"{percent(scene.report.tolerance)} allowed."
    )


def write_picture(
    path: Path, pairs: dict[str, np.ndarray], errors: dict[str, tuple[float, float]]
) -> None:
    """Write all variants side by side as a PNG, Exact first."""
    with TemporaryDirectory() as folder:
        exr = Path(folder, "picture.exr")
        shown = [render.write_display(exr, pair.mean(axis=0)) for pair in pairs.values()]
    captions = [
        [f"off by {100 * errors[name][0]:.2f} ± {100 * errors[name][1]:.2f} %"]
        if name in errors
        else ["the reference"]
        for name in pairs
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = comparison.side_by_side(shown, list(pairs), captions, FOOTER)
    comparison.write_png(path, picture)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m scenes.mixed_demo", description=__doc__)
    parser.add_argument("--tolerance", type=float, default=DEFAULT_TOLERANCE)
    parser.add_argument("--samples", type=int, default=96, help="a pixel (%(default)s)")
    parser.add_argument("--rounds", type=int, default=5, help="of timing (%(default)s)")
    parser.add_argument("--save", type=Path, metavar="FILE", help="also save the scene as .blend")
    arguments = parser.parse_args()
    begin = time.perf_counter()

    def tell(text: str) -> None:
        print(f"{time.perf_counter() - begin:5.0f} s  {text}", flush=True)

    mixed.build()
    AnalysedScene(arguments.tolerance).switch("Walk")
    scene = AnalysedScene(arguments.tolerance)  # all materials are in Walk now
    tell("rendering the reference, Exact")
    pairs = {"Exact": scene.pictures("Exact", 4 * arguments.samples, first_seed=100)}
    errors = {}
    for variant in VARIANTS:
        tell(f"rendering {variant}")
        pairs[variant] = scene.pictures(variant, arguments.samples, first_seed=0)
        errors[variant] = difference(pairs[variant], pairs["Exact"])
    write_picture(PICTURE, pairs, errors)
    tell(f"wrote {PICTURE.relative_to(ROOT)}")
    tell("timing")
    switches = {variant: lambda v=variant: scene.switch(v) for variant in VARIANTS}
    with TemporaryDirectory() as folder, render.messages_to(Path(folder, "log")):
        times = time_samples(bpy.context.scene, switches, samples=24, rounds=arguments.rounds)
    print_result(scene, errors, times)
    if arguments.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(arguments.save.resolve()))


if __name__ == "__main__":
    main()
    leave()
