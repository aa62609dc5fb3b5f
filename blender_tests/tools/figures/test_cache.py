# SPDX-License-Identifier: GPL-3.0-or-later
"""Results are kept, found again, and computed again when what they depend on has changed."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from osl.oracle.surface import BECKMANN, HEIGHT_TRACKED, Surface
from tools.figures import cache, lobes, traced, walked
from tools.figures.masking_curves import MaskingCurve
from tools.figures.walked import Walked

TASK = Walked(Surface(0.5, 0.5, BECKMANN), 0.5, 1 << 8)


@dataclass(frozen=True)
class Failing:
    """A task that fails, or is interrupted."""

    error: type
    cost: int = 1

    def run(self, seed):
        raise self.error("on purpose")


def test_a_result_is_computed_once(tmp_path, monkeypatch):
    first = cache.results([TASK, TASK], tmp_path, 1)[TASK]
    assert [file.name for file in tmp_path.iterdir()] == [f"{cache.key(TASK)}.npz"]
    monkeypatch.setattr(cache, "_run", lambda task: pytest.fail("computed again"))
    again = cache.results([TASK], tmp_path, 1)[TASK]
    for name, value in first.items():
        np.testing.assert_array_equal(value, again[name])
    with pytest.raises(pytest.fail.Exception):
        cache.results([TASK], tmp_path, 1, force=True)


def test_every_parameter_and_source_counts(tmp_path, monkeypatch):
    others = [
        replace(TASK, theta=1.0),
        replace(TASK, walks=1 << 9),
        replace(TASK, surface=replace(TASK.surface, alpha_x=0.25)),
        replace(TASK, surface=replace(TASK.surface, model=HEIGHT_TRACKED)),
        MaskingCurve(TASK.surface, 8),
    ]
    assert len({cache.key(task) for task in (TASK, *others)}) == 1 + len(others)
    assert len({cache.seed(task) for task in (TASK, *others)}) == 1 + len(others)
    before = cache.key(TASK)
    changed = tmp_path / "changed.py"
    changed.write_text("# another source")
    monkeypatch.setattr(cache, "sources", lambda module: (changed,))
    assert cache.key(TASK) != before


def test_sources_are_found_through_imports():
    of_models = {file.name for file in cache.sources(Path(walked.__file__))}
    of_rays = {file.name for file in cache.sources(Path(traced.__file__))}
    assert {"walked.py", "lobes.py", "walk.py", "masking.py", "ndf.py", "visible.py"} <= of_models
    assert {"traced.py", "lobes.py", "simulation.py", "height_field.py", "materials.py"} <= of_rays
    assert "height_field.py" not in of_models
    assert not {file.name for file in cache.sources(Path(lobes.__file__))} - {"lobes.py"}


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_a_failure_keeps_what_is_done_and_nothing_by_halves(tmp_path, error):
    with pytest.raises(error, match="on purpose"):
        cache.results([TASK, Failing(error)], tmp_path, 1)
    assert [file.name for file in tmp_path.iterdir()] == [f"{cache.key(TASK)}.npz"]


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    cache.write(tmp_path / "a.txt", "first")

    def stop(path, content):
        with path.open("wb") as file:
            file.write(content[:2])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", stop)
    with pytest.raises(KeyboardInterrupt):
        cache.write(tmp_path / "a.txt", "second")
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "first"


def test_processes_do_not_change_results(tmp_path):
    tasks = [TASK, replace(TASK, theta=1.0)]
    alone = cache.results(tasks, tmp_path / "1", 1)
    together = cache.results(tasks, tmp_path / "2", 2)
    for task in tasks:
        for name, value in alone[task].items():
            np.testing.assert_array_equal(value, together[task][name])
