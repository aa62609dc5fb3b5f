# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the plan: a child process a scene, one after the other, each watched for silence."""

import queue
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path

from tqdm import tqdm

from blender_tests.figures.cache import ROOT

from .plan import Scene

# A child says after every variant of a round how far it is; the longest takes less than 3 minutes
# on two busy cores, a reference less than 10.
SILENCE = 1200.0
# A child that fails is started once more: it goes on behind what is kept.
ATTEMPTS = 2
_SHOWN = 12  # lines of a failed child's messages


class ChildFailedError(RuntimeError):
    """A scene could not be measured; the message has the end of what its process said."""


def run_scenes(
    plan: str,
    scenes: Sequence[Scene],
    folder: Path,
    log: Path,
    show: bool,
    silence: float = SILENCE,
    command: Callable[..., list[str]] | None = None,
) -> list[str]:
    """Measure the scenes of the plan of this name; return what went wrong, one text a scene.

    silence -- seconds without a word after which a child is ended
    command -- for tests: makes the child's command line from plan, scene's name, folder and log
    """
    command = command or child_command
    failures = []
    total = sum(scene.cost for scene in scenes)
    with tqdm(total=total, unit=" samples", unit_scale=True, disable=not show) as bar:
        for scene in scenes:
            bar.set_postfix_str(scene.name)
            done = 0
            for attempt in range(ATTEMPTS):
                bar.update(-done)  # what an attempt before counted is counted again
                done = 0
                try:
                    for count in _steps(command(plan, scene.name, folder, log), silence):
                        done += count
                        bar.update(count)
                    break
                except ChildFailedError as error:
                    if attempt == ATTEMPTS - 1:
                        failures.append(f"{scene.name}: {error}")
    return failures


def child_command(plan: str, scene: str, folder: Path, log: Path) -> list[str]:
    """The command line that measures one scene."""
    module = "blender_tests.bench.child"
    return [sys.executable, "-m", module, plan, scene, str(folder), "--log", str(log)]


def _steps(command: list[str], silence: float):
    """Yield the samples that a child has done, as it says so. Raises ChildFailedError."""
    child = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    lines: queue.Queue[str | None] = queue.Queue()
    threading.Thread(target=_read, args=(child, lines), daemon=True).start()
    said: list[str] = []
    try:
        while (line := lines.get(timeout=silence)) is not None:
            if line.startswith("STEP "):
                yield int(line.split()[1])
            else:
                said.append(line.rstrip())
        if child.wait(timeout=silence) != 0:
            raise ChildFailedError(f"exit code {child.returncode}\n" + _end(said))
    except (queue.Empty, subprocess.TimeoutExpired):
        raise ChildFailedError(
            f"it said nothing for {silence:g} s and was ended\n" + _end(said)
        ) from None
    finally:
        if child.poll() is None:
            child.kill()
            child.wait()
        child.stderr.close()


def _read(child: subprocess.Popen, lines: "queue.Queue[str | None]") -> None:
    for line in child.stderr:
        lines.put(line)
    lines.put(None)


def _end(said: list[str]) -> str:
    return "\n".join(said[-_SHOWN:])
