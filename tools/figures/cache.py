# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tasks in several processes and keeps their results in a folder.

A task is a frozen dataclass. Its result is kept under a digest of its parameters and of the source
files it depends on. So it is computed again exactly when one of them has changed.
"""

import ast
import hashlib
import io
import multiprocessing
import os
import signal
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import cache
from pathlib import Path
from typing import Protocol

import numpy as np
from tqdm import tqdm

ROOT = Path(__file__).resolve().parents[2]

Result = dict[str, np.ndarray]


class Task(Protocol):
    """A hashable computation whose ``repr`` has all its parameters."""

    cost: int

    def run(self, seed: int) -> Result:
        """The result, a function of the task and the seed alone."""


def seed(task: Task) -> int:
    """A seed made from the task's parameters, so that results depend on nothing else."""
    return int.from_bytes(hashlib.sha256(repr(task).encode()).digest()[:8], "big")


def key(task: Task) -> str:
    """Name of the task's result: a digest of its parameters and its sources."""
    digest = hashlib.sha256(repr(task).encode())
    for file in sources(Path(sys.modules[type(task).__module__].__file__)):
        digest.update(file.read_bytes())
    return f"{type(task).__name__.lower()}-{digest.hexdigest()[:24]}"


@cache
def sources(module: Path) -> tuple[Path, ...]:
    """The project's source files that a module imports, itself and indirect ones included."""
    found: set[Path] = set()
    left = [module]
    while left:
        file = left.pop()
        if file not in found:
            found.add(file)
            left.extend(_imported(file))
    return tuple(sorted(found))


def _imported(module: Path) -> Iterator[Path]:
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom):
            continue
        folder = module.parents[node.level - 1] if node.level else ROOT
        target = folder.joinpath(*(node.module or "").split("."))
        names = [target / alias.name for alias in node.names]
        for one in (target, target / "__init__", *names):
            if one.with_suffix(".py").is_file():
                yield one.with_suffix(".py")


def results(
    tasks: Iterable[Task], folder: Path, jobs: int, force: bool = False, show: bool = False
) -> dict[Task, Result]:
    """The results of ``tasks``, read from ``folder``, or computed and kept there if missing.

    ``jobs``: the number of processes; 1 works in this one. ``force`` computes all again. ``show``
    shows a progress bar.
    """
    tasks = list(dict.fromkeys(tasks))
    folder.mkdir(parents=True, exist_ok=True)
    paths = {task: folder / f"{key(task)}.npz" for task in tasks}
    missing = [task for task in tasks if force or not paths[task].exists()]
    total = sum(task.cost for task in missing)
    with tqdm(total=total, unit=" walks", unit_scale=True, disable=not (show and missing)) as bar:
        for task, result in _computed(missing, jobs):
            buffer = io.BytesIO()
            np.savez_compressed(buffer, **result)
            write(paths[task], buffer.getvalue())
            bar.update(task.cost)
    return {task: _read(path) for task, path in paths.items()}


def write(path: Path, content: bytes | str) -> None:
    """Write a file whole or not at all."""
    content = content.encode() if isinstance(content, str) else content
    temporary = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        temporary.write_bytes(content)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _read(path: Path) -> Result:
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def _run(task: Task) -> Result:
    return task.run(seed(task))


def _die_on_interrupt() -> None:
    """Let Ctrl-C end a worker without a traceback of its own."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _computed(tasks: list[Task], jobs: int) -> Iterator[tuple[Task, Result]]:
    """Tasks with their results, in the order in which they finish."""
    if jobs == 1 or len(tasks) < 2:
        for task in tasks:
            yield task, _run(task)
        return
    # a forked process would lack Embree's threads
    context = multiprocessing.get_context("spawn")
    longest_first = sorted(tasks, key=lambda task: -task.cost)
    with ProcessPoolExecutor(jobs, context, _die_on_interrupt) as pool:
        running = {pool.submit(_run, task): task for task in longest_first}
        try:
            for future in as_completed(running):
                yield running[future], future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
