# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the reference pictures: ``python -m blender_tests.oracle.references``.

Each file holds the layers ``mean`` (R, G, B), ``error`` (its standard error), ``single`` (first
bounce alone; not in the furnace) and ``mask``, with the case in its metadata. The walks per point
of a case are chosen so that the error, as image L2, is at most 0.3 % of the picture's.
"""

import argparse
import hashlib
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm import tqdm

from . import exr
from .fresnel import F82Tint, IndexOfRefraction
from .materials import Conductor
from .sphere import RESOLUTION, furnace_picture, sun_picture
from .surface import BECKMANN, GGX, Surface

FOLDER = Path(__file__).resolve().parent.parent / "references"
COMMAND = "python -m blender_tests.oracle.references"

# A gold-like metal by colours, and copper by its index near 630, 530 and 465 nm (rounded).
GOLD = F82Tint((0.95, 0.75, 0.35), (0.98, 0.95, 0.75))
COPPER = IndexOfRefraction((0.20, 0.92, 1.10), (3.91, 2.45, 2.14))


@dataclass(frozen=True)
class Case:
    """One reference picture: its surface, light, walks per point (64 points a pixel) and seed."""

    name: str
    surface: Surface
    walks: int
    seed: int
    furnace: bool = False

    def metadata(self) -> dict[str, str]:
        """What the file's header says, so that the picture can be made again."""
        return {
            "alpha": f"{self.surface.alpha_x} {self.surface.alpha_y}",
            "distribution": self.surface.distribution,
            "fresnel": repr(self.surface.material.fresnel),
            "light": "uniform world, radiance 1" if self.furnace else "sun, irradiance 1",
            "model": "height-correlated",
            "walks per point": str(self.walks),
            "seed": str(self.seed),
            "command": f"{COMMAND} --case {self.name}",
        }


CASES = (
    Case("sun_white_ggx_0.25", Surface(0.25, 0.25, GGX), 256, 1),
    Case("sun_white_ggx_0.5", Surface(0.5, 0.5, GGX), 512, 2),
    Case("sun_white_ggx_1", Surface(1.0, 1.0, GGX), 384, 3),
    Case("sun_white_ggx_1_0.1", Surface(1.0, 0.1, GGX), 640, 4),
    Case("sun_white_beckmann_0.25", Surface(0.25, 0.25, BECKMANN), 32, 5),
    Case("sun_white_beckmann_0.5", Surface(0.5, 0.5, BECKMANN), 192, 6),
    Case("sun_white_beckmann_1", Surface(1.0, 1.0, BECKMANN), 544, 7),
    Case("sun_white_beckmann_1_0.1", Surface(1.0, 0.1, BECKMANN), 640, 8),
    Case("sun_gold_ggx_0.5", Surface(0.5, 0.5, GGX, Conductor(GOLD)), 512, 9),
    Case("sun_copper_beckmann_0.5", Surface(0.5, 0.5, BECKMANN, Conductor(COPPER)), 192, 10),
    Case("furnace_gold_ggx_0.5", Surface(0.5, 0.5, GGX, Conductor(GOLD)), 32, 11, furnace=True),
)


def relative_error(picture: dict[str, np.ndarray]) -> float:
    """Standard error of a picture as image L2, relative to the picture's own."""
    return float(np.linalg.norm(picture["error"]) / np.linalg.norm(picture["mean"]))


def render(case: Case, quick: bool = False, show: bool = False) -> dict[str, np.ndarray]:
    """Layers of a case; ``quick`` takes a sixteenth of its walks (2 at least); ``show`` a bar."""
    picture = furnace_picture if case.furnace else sun_picture
    walks = max(2, case.walks // 16) if quick else case.walks

    def bar(rows: Sequence[int]) -> tqdm:
        return tqdm(rows, desc=f"{case.name:26}", unit="row", disable=not show)

    return picture(case.surface, walks, case.seed, RESOLUTION, bar)


def _note_in_manifest(folder: Path, case: Case, path: Path, error: float) -> None:
    """Keep the list of files with their checksums, in the order of `CASES`."""
    manifest = folder / "manifest.json"
    entries = json.loads(manifest.read_text()) if manifest.exists() else {}
    entries[case.name] = {
        "file": path.name,
        "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "relative_error": float(f"{error:.3g}"),
        **case.metadata(),
    }
    ordered = {one.name: entries[one.name] for one in CASES if one.name in entries}
    manifest.write_text(json.dumps(ordered, indent=2) + "\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; returns the exit code, 1 when a picture misses its accuracy."""
    parser = argparse.ArgumentParser(prog=COMMAND, description="Make the reference pictures.")
    parser.add_argument(
        "--case",
        action="append",
        choices=[case.name for case in CASES],
        metavar="NAME",
        help="make only this picture, named as its file; may be given several times",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="a sixteenth of the walks, to see that it works; needs --output",
    )
    parser.add_argument("--output", type=Path, help=f"folder to write (default: {FOLDER.name})")
    options = parser.parse_args(arguments)
    if options.quick and options.output is None:
        parser.error("--quick must not replace the references; name a folder with --output")
    folder = options.output or FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    failures = 0
    for case in CASES:
        if options.case and case.name not in options.case:
            continue
        started = time.perf_counter()
        picture = render(case, options.quick, show=sys.stderr.isatty())
        error = relative_error(picture)
        path = folder / f"{case.name}.exr"
        exr.write(path, picture, case.metadata())
        _note_in_manifest(folder, case, path, error)
        seconds = time.perf_counter() - started
        size = path.stat().st_size / 1024
        print(
            f"{case.name:26} error {100 * error:.3f} %  {seconds:6.1f} s  {size:.0f} KB", flush=True
        )
        if error > 0.003 and not options.quick:
            print(f"{case.name}: the error exceeds 0.3 %; raise its walks", file=sys.stderr)
            failures = 1
    return failures


if __name__ == "__main__":
    sys.exit(main())
