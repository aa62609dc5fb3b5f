# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the plan: a child process for each scene, one after the other. Ends silent children."""

import queue
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tqdm import tqdm

from tools.figures.cache import ROOT

from .plan import Scene

# A child reports after each variant of a round. On two busy cores the longest takes under 3
# minutes, a reference under 10.
SILENCE = 1200.0
# A child that fails starts once more, and goes on after its kept results.
ATTEMPTS = 2
_SELDOM = 30.0  # seconds between two lines of progress in a log
_SHOWN = 12  # last lines of a failed child's messages


class ChildFailedError(RuntimeError):
    """A scene could not be measured. The message has the last lines of its process."""


def run_scenes(
    plan: str,
    scenes: Sequence[Scene],
    folder: Path,
    log: Path,
    show: bool,
    repeat: int = 1,
    silence: float = SILENCE,
    command: Callable[..., list[str]] | None = None,
) -> list[str]:
    """Measure scenes of the plan of this name; return a text for each scene that failed.

    show    -- whether the progress bar moves, for a terminal, or prints a line now and then
    repeat  -- multiple of the plan's rounds, which `scenes` have already
    silence -- a child that prints nothing for so many seconds is ended
    command -- for tests: makes the child's command line, with the arguments of child_command()
    """
    command = command or child_command
    failures = []
    total = sum(scene.whole_work for scene in scenes)
    # Paths of different scenes take different times, so the time left goes by the whole run.
    often = 0.1 if show else _SELDOM
    with tqdm(total=total, unit=" paths", unit_scale=True, smoothing=0, mininterval=often) as bar:
        for scene in scenes:
            bar.set_postfix_str(scene.name)
            before = bar.n
            for attempt in range(ATTEMPTS):
                bar.n = before
                try:
                    for new, paths in _steps(
                        command(plan, scene.name, folder, log, repeat), silence
                    ):
                        if not new:
                            bar.initial += paths  # they took no time
                        bar.update(paths)
                    break
                except ChildFailedError as error:
                    if attempt == ATTEMPTS - 1:
                        failures.append(f"{scene.name}: {error}")
    return failures


def child_command(plan: str, scene: str, folder: Path, log: Path, repeat: int) -> list[str]:
    """The command line that measures one scene."""
    return [
        sys.executable, "-m", "tools.bench.child", plan, scene, str(folder),
        "--log", str(log), "--repeat", str(repeat),
    ]  # fmt: skip


def _steps(command: list[str], silence: float) -> Iterator[tuple[bool, int]]:
    """Yield (whether paths were just rendered, how many) as the child reports them.

    Raises ChildFailedError.
    """
    child = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    lines: queue.Queue[str | None] = queue.Queue()
    threading.Thread(target=_read, args=(child, lines), daemon=True).start()
    said: list[str] = []
    try:
        while (line := lines.get(timeout=silence)) is not None:
            if line.startswith(("STEP ", "KEPT ")):
                yield line.startswith("STEP "), int(line.split()[1])
            else:
                said.append(line.rstrip())
        if child.wait(timeout=silence) != 0:
            raise ChildFailedError(f"exit code {child.returncode}\n" + _end(said))
    except (queue.Empty, subprocess.TimeoutExpired):
        raise ChildFailedError(
            f"it printed nothing for {silence:g} s and was ended\n" + _end(said)
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
