# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the showcase with Single, Cycles' energy compensation, Fitted and Walk to compare them.

Writes pictures into build/demo and prints times and energies. Each variant is rendered in a few
interleaved passes, each with its own seed. Their mean is the picture. Their spread gives its noise.
Their times without a one-sample warm-up give the seconds per sample. The denoiser and adaptive
sampling are off.
"""

import argparse
import os
import statistics
import time
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from tqdm import tqdm

from . import comparison, furnace, render, variants
from .leave import leave

ROOT = Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes" / "showcase.blend"
PASSES = 4
SAMPLES = 96


@dataclass
class Variant:
    """One way to render the metals, with its measurements."""

    key: str
    title: str
    switch: str
    pictures: list[np.ndarray] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    warm_up: float = 0.0

    @property
    def radiance(self) -> np.ndarray:
        """The mean of the passes, linear (height, width, 3)."""
        return np.mean(self.pictures, axis=0)

    def noise(self, mask: np.ndarray) -> float:
        """Return the standard error of a pixel of `mask` over the mean radiance there."""
        spread = np.std(self.pictures, axis=0, ddof=1)[mask] / np.sqrt(len(self.pictures))
        return float(np.sqrt(np.mean(spread**2)) / np.mean(self.radiance[mask]))

    def per_sample(self, samples: int) -> float:
        """Return the median seconds per sample if a pass has `samples`, 2 or more."""
        times = [(seconds - self.warm_up) / (samples - 1) for seconds in self.seconds]
        return statistics.median(times)

    def apply(self, metals: list[variants.Material]) -> None:
        """Switch the open scene to this variant."""
        if self.switch == "CYCLES":
            variants.use_cycles_multiscatter(metals)
        else:
            variants.use_quality(metals, self.switch)


def compared_variants() -> list[Variant]:
    """Return the compared variants, the single bounce first."""
    return [
        Variant("single", "Single bounce", "Single"),
        Variant("cycles_multiscatter", "Cycles Multiscatter", "CYCLES"),
        Variant("fitted", "Microbounce Fitted", "Fitted"),
        Variant("walk", "Microbounce Walk", "Walk"),
    ]


def render_variants(
    compared: list[Variant], metals: list[variants.Material], folder: Path, samples: int
) -> np.ndarray:
    """Render all passes into `compared`; return the object index of each pixel, (rows, columns)."""
    log = folder / "blender.log"
    work = folder / "pass.exr"
    per_pass = max(2, samples // PASSES)
    # Builds the scene and starts the threads, so no variant pays for it.
    compared[0].apply(metals)
    render.render_passes(work, 1, 0, log)
    steps = tqdm(total=(PASSES + 1) * len(compared), desc="Rendering", unit="pass")
    for variant in compared:
        steps.set_postfix_str(f"{variant.title}, warm-up")
        variant.apply(metals)
        render.render_passes(work, 1, 0, log)
        variant.warm_up = render.render_passes(work, 1, 0, log)[1]
        steps.update()
    passes = {}
    for number in range(PASSES):
        for variant in compared:
            steps.set_postfix_str(variant.title)
            variant.apply(metals)
            passes, seconds = render.render_passes(work, per_pass, 1 + number, log)
            variant.pictures.append(render.combined(passes))
            variant.seconds.append(seconds)
            steps.update()
    steps.close()
    work.unlink()
    return np.rint(passes["IndexOB.X"]).astype(int)


def energies(variant: Variant, index: np.ndarray, metals: list[variants.Material]) -> list[float]:
    """Return the mean radiance over all metals, then over each."""
    radiance = variant.radiance
    masks = [index > 0, *(index == metal.index for metal in metals)]
    return [float(radiance[mask].mean()) for mask in masks]


def captions(
    compared: list[Variant], index: np.ndarray, metals: list[variants.Material], per_pass: int
) -> list[list[str]]:
    """Return the lines under each picture."""
    base = energies(compared[0], index, metals)
    lines = []
    for variant in compared:
        ratios = [e / b for e, b in zip(energies(variant, index, metals), base, strict=True)]
        each = ", ".join(
            f"{metal.name.lower()} {ratio:.2f}"
            for metal, ratio in zip(metals, ratios[1:], strict=True)
        )
        lines.append(
            [
                f"Light of the metals: {ratios[0]:.2f}   |   {sum(variant.seconds):.0f} s   |   "
                f"{1000 * variant.per_sample(per_pass):.0f} ms a sample",
                each,
            ]
        )
    return lines


def print_report(
    compared: list[Variant],
    index: np.ndarray,
    metals: list[variants.Material],
    white: dict[str, list[float]],
    per_pass: int,
) -> None:
    """Print the tables of energies and times."""
    names = ["all metals", *(metal.name for metal in metals)]
    width = max(len(variant.title) for variant in compared) + 2
    header = "".join(f"{name:>15}" for name in names)
    base = energies(compared[0], index, metals)

    print("\nMean radiance of the metals' pixels, relative to Single")
    print(f"{'':{width}}{header}")
    for variant in compared:
        ratios = [e / b for e, b in zip(energies(variant, index, metals), base, strict=True)]
        print(f"{variant.title:{width}}" + "".join(f"{ratio:15.3f}" for ratio in ratios))

    print("\nEnergy in a white furnace, the same surfaces made lossless (1 is right)")
    print(f"{'':{width}}{'':15}" + "".join(f"{metal.name:>15}" for metal in metals))
    for variant in compared:
        row = "".join(f"{energy:15.3f}" for energy in white[variant.key])
        print(f"{variant.title:{width}}{'':15}{row}")

    print(f"\nCost and noise of {PASSES} x {per_pass} samples a pixel")
    print(f"{'':{width}}{'seconds':>15}{'ms a sample':>15}{'over Single':>15}{'noise':>15}")
    for variant in compared:
        time_ratio = variant.per_sample(per_pass) / compared[0].per_sample(per_pass)
        print(
            f"{variant.title:{width}}{sum(variant.seconds):15.1f}"
            f"{1000 * variant.per_sample(per_pass):15.1f}{time_ratio:15.2f}"
            f"{100 * variant.noise(index > 0):14.2f}%"
        )
    print("Cycles has no Beckmann with further bounces, so its copper has a single bounce.")


def main() -> None:
    """Render, compare and print."""
    parser = argparse.ArgumentParser(prog="python -m scenes.demo", description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "demo", metavar="FOLDER")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="a pixel (%(default)s)")
    parser.add_argument("--picture", type=Path, help="also write the comparison there, as JPEG")
    arguments = parser.parse_args()
    if arguments.samples < 2 * PASSES:
        parser.error(f"--samples {arguments.samples}: give {2 * PASSES} or more")
    if not SCENE.is_file():
        parser.error(f"{SCENE} is missing: build it with 'make scenes'")

    begin = time.perf_counter()
    folder = arguments.output.resolve()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "blender.log").write_text("")
    except OSError as error:
        parser.error(f"--output {folder} cannot be written ({error}): give another folder")
    print(f"Blender {bpy.app.version_string}, {os.cpu_count()} cores, OSL on; into {folder}")
    with render.messages_to(folder / "blender.log"):
        bpy.ops.wm.open_mainfile(filepath=str(SCENE))
    metals = variants.find_materials()
    compared = compared_variants()
    per_pass = arguments.samples // PASSES
    index = render_variants(compared, metals, folder, arguments.samples)

    shown = [render.write_display(folder / f"{one.key}.exr", one.radiance) for one in compared]
    footer = (
        f"Blender {bpy.app.version_string}, {PASSES * per_pass} samples a pixel, "
        f"{os.cpu_count()} CPU cores, OSL on, no denoiser. "
        "Light: mean radiance of the metals' pixels over that of Single."
    )
    picture = comparison.side_by_side(
        shown,
        [variant.title for variant in compared],
        captions(compared, index, metals, per_pass),
        footer,
    )
    comparison.write_png(folder / "comparison.png", picture)
    if arguments.picture:
        comparison.write_jpeg(arguments.picture, picture)

    white = furnace.energies(metals, {v.key: v.apply for v in compared}, folder / "blender.log")
    print_report(compared, index, metals, white, per_pass)
    print(f"\n{time.perf_counter() - begin:.0f} s in all. Look at {folder / 'comparison.png'}")


if __name__ == "__main__":
    main()
    leave()
