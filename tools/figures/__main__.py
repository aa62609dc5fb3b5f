# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the figures: ``python -m tools.figures``."""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from . import draw, draw_curves, draw_lobes, tables
from .cache import ROOT, results, write
from .cases import FULL, MASKING, NUMBERS, QUICK, RECIPROCITY, Effort, name, settled, tasks, whole
from .findings import Findings, to_simulated, to_tracked
from .report import report

FOLDER = ROOT / "docs" / "figures"
CACHE = ROOT / "build" / "figures"
COMMAND = "python -m tools.figures"


def files(found: Findings) -> dict[str, str]:
    """Names and contents of the figures' files."""
    made = {}
    with draw.style():
        if found.masking:
            made[f"{name(MASKING)}.svg"] = draw_curves.draw_masking(found.masking)
            made[f"{name(MASKING)}.csv"] = tables.masking(found.masking)
        for figure, panels in found.lobes.items():
            start = name(figure.number)
            made[f"{start}.svg"] = draw_lobes.draw(figure, panels)
            made[f"{start}_energies.csv"] = tables.energies(panels)
            made[f"{start}_lobes.csv"] = tables.lobes(figure, panels)
        if found.pairs:
            made[f"{name(RECIPROCITY)}.svg"] = draw_curves.draw_reciprocity(found.pairs)
            made[f"{name(RECIPROCITY)}.csv"] = tables.reciprocity(found.pairs)
    return made


def summary(found: Findings, effort: Effort) -> dict[str, str]:
    """Names and contents of the files about all figures together."""
    return {
        "README.md": report(found, effort),
        "distances_to_simulated.csv": tables.distances(to_simulated(found)),
        "distances_to_height_tracked.csv": tables.distances(to_tracked(found)),
        "ggx_energies.csv": tables.ggx_energies(found.ggx),
        "estimators.csv": tables.estimators(found),
        "estimators_settled.csv": tables.settled(found),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog=COMMAND,
        description="Draw the supplement's figures, with their numbers as CSV and a README.",
    )
    parser.add_argument(
        "--only",
        type=int,
        nargs="+",
        choices=NUMBERS,
        metavar="NUMBER",
        help="draw only these figures, without the README",
    )
    parser.add_argument(
        "--quick", action="store_true", help="take few walks, to see that it works; needs --output"
    )
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="processes (default: %(default)s)"
    )
    parser.add_argument("--output", type=Path, help="folder to write (default: docs/figures)")
    parser.add_argument(
        "--cache", type=Path, default=CACHE, help="folder of results (default: build/figures)"
    )
    parser.add_argument(
        "--force", action="store_true", help="compute everything anew, even if it is in the cache"
    )
    options = parser.parse_args(arguments)
    if options.quick and options.output is None:
        parser.error("--quick must not replace the figures; name a folder with --output")
    if options.jobs < 1:
        parser.error(f"--jobs is {options.jobs}; give 1 or more")
    started = time.perf_counter()
    effort = QUICK if options.quick else FULL
    numbers = options.only or NUMBERS
    try:
        how = options.cache, options.jobs, options.force, sys.stderr.isatty()
        computed = results(tasks(numbers, effort), *how)
        if whole(numbers):
            computed |= results(settled(computed, effort).values(), *how)
    except KeyboardInterrupt:
        print(f"\nInterrupted. Finished results are in {options.cache}", file=sys.stderr)
        return 130
    found = Findings.sort(computed, numbers, effort)
    made = files(found) | (summary(found, effort) if whole(numbers) else {})
    folder = options.output or FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in made.items():
        write(folder / file, content)
    seconds = time.perf_counter() - started
    print(f"{len(made)} files in {folder}, {seconds:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
