# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the reference pictures: ``python -m osl.oracle.references``.

Each file holds the layers ``mean`` (R, G, B), ``error`` (its standard error), ``single`` (first
bounce alone; not in the furnace) and ``mask``, with the case in its metadata. A
case has enough walks per point that the error, as image L2, is at most `Case.limit` of the
picture. reference_cases.py lists the cases.
"""

import argparse
import hashlib
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tqdm import tqdm

from . import exr
from .picture import furnace_picture, sun_picture
from .reference_cases import CASES, COMMAND, Case

FOLDER = Path(__file__).resolve().parents[2] / "blender_tests/references"


def relative_error(picture: dict[str, np.ndarray]) -> float:
    """Standard error of a picture as image L2, relative to the picture's own."""
    return float(np.linalg.norm(picture["error"]) / np.linalg.norm(picture["mean"]))


def render(
    case: Case, quick: bool = False, show: bool = False, rows: Sequence[int] | None = None
) -> dict[str, np.ndarray]:
    """The layers of a case.

    ``quick`` takes a sixteenth of its walks (2 at least), ``show`` shows a progress bar, and
    ``rows`` renders these rows alone.
    """
    walks = max(2, case.walks // 16) if quick else case.walks

    def bar(every: Sequence[int]) -> tqdm:
        return tqdm(rows or every, desc=f"{case.name:40}", unit="row", disable=not show)

    view = case.light.view(subsamples=case.subsamples)
    if case.light.sun is None:
        return furnace_picture(view, case.surface, walks, case.seed, bar)
    return sun_picture(view, case.light.sun, case.surface, walks, case.seed, bar)


def _note_in_manifest(folder: Path, case: Case, path: Path, error: float) -> None:
    """Note the file and its checksum in the manifest, in the order of `CASES`."""
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
    """Run the command line; returns the exit code, 1 if a picture misses its accuracy."""
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
        exr.write(path, picture, case.metadata(), case.half)
        _note_in_manifest(folder, case, path, error)
        seconds = time.perf_counter() - started
        size = path.stat().st_size / 1024
        print(
            f"{case.name:40} error {100 * error:.3f} %  {seconds:6.1f} s  {size:.0f} KB", flush=True
        )
        if error > case.limit and not options.quick:
            print(
                f"{case.name}: the error exceeds {case.limit:.1%}; raise its walks", file=sys.stderr
            )
            failures = 1
    return failures


if __name__ == "__main__":
    sys.exit(main())
