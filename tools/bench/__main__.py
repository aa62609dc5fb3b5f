# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what accuracy costs: ``python -m tools.bench``."""

import argparse
import shutil
import sys
import time
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from tools.figures import draw as style
from tools.figures.cache import ROOT, write

from . import check, draw, estimate, page, tables
from .findings import MissingResultError, SceneFindings, read_scenes
from .machine import this_machine
from .plan import PLANS, Scene
from .runner import run_scenes
from .targets import targets

FOLDER = ROOT / "docs" / "benchmarks"
CACHE = ROOT / "build" / "bench"
RATIOS = FOLDER / "ratios.json"
COMMAND = "python -m tools.bench"
# The headline shows these scenes if they were measured.
HEADLINE = ("slab_0.6", "sun_white", "showcase")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code: 0 fine, 1 slower or not measured, 2 wrong use."""
    options = _options(arguments)
    started = time.perf_counter()
    name = _plan_name(options)
    scenes = [s for s in PLANS[name] if not options.only or s.name in options.only]
    folder = options.cache / "check" if options.check else options.cache
    try:
        if options.check:
            return _check(folder)
        found = _measured(name, scenes, folder, check.RECORDED if options.record else 1)
        if options.record:
            _record(found)
        if name == "trial" and not options.only:
            _tell_estimate(found)
        if name == "full" and not options.only:
            _record(_measured("quick", PLANS["quick"], folder, check.RECORDED))
    except KeyboardInterrupt:
        print(f"\nInterrupted. Finished results are kept in {folder}", file=sys.stderr)
        return 130
    except (MissingResultError, check.RatiosError) as error:
        print(f"Error: {error}", file=sys.stderr)
        return 1
    if not options.record:
        output = options.output or FOLDER
        made = files(found, whole=not options.only)
        output.mkdir(parents=True, exist_ok=True)
        for file, content in made.items():
            write(output / file, content)
        print(f"{len(made)} files in {output}")
    print(f"{time.perf_counter() - started:.0f} s")
    return 0


def files(found: Mapping[str, SceneFindings], whole: bool) -> dict[str, str]:
    """Contents of all files by name; only the scenes' own plots if not ``whole``."""
    made = {}
    with style.style():
        for name, one in found.items():
            if any(curve.known for curve in one.curves.values()) and not one.scene.is_sweep:
                made[f"{name}.svg"] = draw.draw_scene(one)
        if not whole:
            return made
        headline = [found[name] for name in HEADLINE if f"{name}.svg" in made]
        if headline:
            made["headline.svg"] = draw.draw_headline(headline)
        if sweeps := draw.draw_sweeps(dict(found)):
            made["sweeps.svg"] = sweeps
    aims = targets(found)
    return made | {
        "README.md": page.page(found, aims),
        "curves.csv": tables.curves(found),
        "costs.csv": tables.costs(found),
        "results.json": tables.results(found, aims),
    }


def _measured(
    name: str, scenes: Sequence[Scene], folder: Path, repeat: int = 1
) -> dict[str, SceneFindings]:
    """Measure what is missing; return all findings. Raises MissingResultError with what failed."""
    folder.mkdir(parents=True, exist_ok=True)
    scenes = [scene.repeated(repeat) for scene in scenes]
    log = folder / "blender.log"
    failures = run_scenes(name, scenes, folder, log, sys.stderr.isatty(), repeat)
    if failures:
        raise MissingResultError(
            "not all scenes were measured. Finished results are kept.\n" + "\n".join(failures)
        )
    return read_scenes(scenes, folder)


def _record(found: Mapping[str, SceneFindings]) -> None:
    """Store the ratios of a quick run."""
    machine = next(iter(found.values())).machine.as_dict()
    RATIOS.parent.mkdir(parents=True, exist_ok=True)
    write(RATIOS, check.write_ratios(check.ratios(found), machine))
    print(f"Recorded {len(check.CHECKED)} ratios in {RATIOS.name}")


def _tell_estimate(trial: Mapping[str, SceneFindings]) -> None:
    for name in ("full", "quick"):
        minutes = estimate.seconds(PLANS[name], trial) / 60.0
        print(f"The {name} plan takes about {minutes:.1f} minutes if nothing else runs.")


def _check(folder: Path) -> int:
    stored = check.read_ratios(RATIOS, this_machine().blender)
    # Only times of the same hour compare.
    shutil.rmtree(folder, ignore_errors=True)

    def measured(names: Collection[str], times: int) -> dict[str, SceneFindings]:
        return _measured("quick", [s for s in PLANS["quick"] if s.name in names], folder, times)

    growths = check.settled(stored, measured)
    for growth in growths:
        print(f"{'SLOWER' if growth.slower else 'ok    '}  {growth}")
    slower = sum(growth.slower for growth in growths)
    if slower:
        print(f"Error: {slower} of {len(growths)} ratios grew past their margins. If you meant "
              "that, record them anew: --quick --record", file=sys.stderr)  # fmt: skip
    return 1 if slower else 0


def _plan_name(options: argparse.Namespace) -> str:
    return "quick" if options.quick or options.check else "trial" if options.trial else "full"


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog=COMMAND,
        description="Measure error over time of every quality and of Cycles' own closures. Write "
        "plots, a README, and the numbers as CSV and JSON.",
    )
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--quick", action="store_true", help="few scenes and samples, two minutes")
    how.add_argument(
        "--trial",
        action="store_true",
        help="every scene with few samples, to see that all works and how long a run takes",
    )
    how.add_argument(
        "--check", action="store_true", help="a quick run that fails if a stored ratio grew"
    )
    names = sorted({scene.name for plan in PLANS.values() for scene in plan})
    parser.add_argument(
        "--only",
        nargs="+",
        metavar="SCENE",
        help=f"only these, and no README: {', '.join(names)}",
    )
    parser.add_argument(
        "--record", action="store_true", help="store the ratios of a quick run, write no page"
    )
    parser.add_argument("--output", type=Path, help="folder to write (default: docs/benchmarks)")
    parser.add_argument(
        "--cache", type=Path, default=CACHE, help="folder of results (default: build/bench)"
    )
    options = parser.parse_args(arguments)
    plan = PLANS[_plan_name(options)]
    unknown = set(options.only or ()) - {scene.name for scene in plan}
    if unknown:
        parser.error(f"--only {' '.join(sorted(unknown))}: the scenes of this plan are "
                     f"{', '.join(scene.name for scene in plan)}")  # fmt: skip
    if options.record and (not options.quick or options.only):
        parser.error("--record stores the ratios of a whole quick run: give --quick and no --only")
    if options.check and options.only:
        parser.error("--check compares all ratios: leave --only out")
    if (options.quick or options.trial) and options.output is None and not options.record:
        parser.error("a short run must not replace the page; name a folder with --output")
    return options


if __name__ == "__main__":
    sys.exit(main())
