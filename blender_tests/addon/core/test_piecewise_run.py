# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in small pieces, done at once or as a run: no Blender is needed."""

import pytest

from addon.core import run
from addon.core.run import PiecewiseRun, Progress, done_at_once, wait_for


def counting(ended: list[str]):
    """Four pieces; tells when it is over."""
    try:
        for number in range(4):
            yield number / 4
        return "done"
    finally:
        ended.append("ended")


def test_all_is_done_at_once() -> None:
    told: list[float] = []
    assert done_at_once(counting([]), told.append) == "done"
    assert told == [0.0, 0.25, 0.5, 0.75]


def test_it_runs_to_its_end() -> None:
    ended: list[str] = []
    assert wait_for(PiecewiseRun(counting(ended))) == "done"
    assert ended == ["ended"]


def test_a_slice_of_time_leaves_the_rest(monkeypatch) -> None:
    """Here there is time for a piece at a time."""
    clock = iter(range(100))
    monkeypatch.setattr(run.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(run, "_SLICE_SECONDS", 2)
    ended: list[str] = []
    begun = PiecewiseRun(counting(ended))
    assert begun.advance()
    assert begun.advance()
    assert begun.progress() == Progress(0.25, "25 %")
    begun.close()
    assert ended == ["ended"]


def test_what_goes_wrong_is_told() -> None:
    def failing():
        yield 0.0
        raise ValueError("bad")

    with pytest.raises(ValueError, match="bad"):
        PiecewiseRun(failing()).advance()
