# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that follow a run: progress, Esc, errors, and the end, with and without a window."""

from types import SimpleNamespace

import pytest

from addon.core.run import RunError
from addon.operators.following import FollowsRun

from .fake_run import FakeRun

TIMER = SimpleNamespace(type="TIMER", value="NOTHING")
ESC = SimpleNamespace(type="ESC", value="PRESS")
MOUSE = SimpleNamespace(type="MOUSEMOVE", value="NOTHING")


class Manager:
    """What a window manager is asked to do."""

    def __init__(self):
        area = SimpleNamespace(type="PROPERTIES", tag_redraw=lambda: None)
        self.windows = [SimpleNamespace(screen=SimpleNamespace(areas=[area]))]
        self.shown, self.timers, self.handlers = [], 0, []

    def event_timer_add(self, interval, window):
        self.timers += 1

    def event_timer_remove(self, timer):
        self.timers -= 1

    def progress_begin(self, low, high):
        self.shown.append("begin")

    def progress_update(self, value):
        self.shown.append(value)

    def progress_end(self):
        self.shown.append("end")

    def modal_handler_add(self, operator):
        self.handlers.append(operator)


class Follower(FollowsRun):
    """An operator outside Blender's register."""

    title = "Baking"

    def __init__(self, run):
        self.run, self.results, self.reports = run, [], []

    @classmethod
    def poll_message_set(cls, text):
        cls.told = text

    def start(self, context):
        if isinstance(self.run, str):
            raise RunError(self.run)
        return self.run

    def finish(self, context, result):
        self.results.append(result)
        return {"FINISHED"}

    def report(self, kind, text):
        self.reports.append((*kind, text))


@pytest.fixture
def context():
    """A context with a window, and the texts of its status bar."""
    status = []
    workspace = SimpleNamespace(status_text_set=status.append)
    return SimpleNamespace(window_manager=Manager(), window=None, workspace=workspace, said=status)


@pytest.fixture
def window(monkeypatch):
    """Operators think that there is a window."""
    from addon.operators import following

    app = SimpleNamespace(background=False)
    monkeypatch.setattr(following, "bpy", SimpleNamespace(app=app))


def clean(context, follower):
    """Whether nothing of the run is left."""
    manager = context.window_manager
    ended = manager.timers == 0 and manager.shown[-1] == "end" and context.said[-1] is None
    return ended and follower.progress is None and follower.run.closed == 1


def test_a_run_is_followed_to_its_end(context, window):
    follower = Follower(FakeRun(steps=3, result="done"))
    assert follower.is_idle()
    assert follower.follow(context) == {"RUNNING_MODAL"}
    assert not Follower.is_idle()
    assert "Esc" in Follower.told
    assert follower.modal(context, MOUSE) == {"PASS_THROUGH"}
    for step in (1, 2, 3):
        assert follower.modal(context, TIMER) == {"PASS_THROUGH"}
        assert follower.progress.text == f"step {step}"
        assert context.said[-1] == f"Baking: Esc cancels  |  step {step}"
    assert follower.modal(context, TIMER) == {"FINISHED"}
    assert follower.results == ["done"]
    assert clean(context, follower)


def test_all_else_waits_for_what_is_alone(context, window):
    follower = Follower(FakeRun(steps=1))
    follower.alone = True
    follower.follow(context)
    for event in (MOUSE, TIMER):
        assert follower.modal(context, event) == {"RUNNING_MODAL"}
    assert follower.modal(context, ESC) == {"CANCELLED"}
    assert clean(context, follower)


def test_esc_ends_it(context, window):
    follower = Follower(FakeRun(steps=3))
    follower.follow(context)
    follower.modal(context, TIMER)
    assert follower.modal(context, ESC) == {"CANCELLED"}
    assert follower.reports == [("INFO", "Baking: cancelled")]
    assert follower.results == []
    assert clean(context, follower)


def test_another_file_ends_it(context, window):
    follower = Follower(FakeRun(steps=3))
    follower.follow(context)
    context.workspace = None
    follower.cancel(context)
    assert (follower.progress, follower.run.closed, context.window_manager.timers) == (None, 1, 0)


def test_a_failure_is_reported(context, window):
    follower = Follower(FakeRun(steps=1, error="No room"))
    follower.follow(context)
    follower.modal(context, TIMER)
    assert follower.modal(context, TIMER) == {"CANCELLED"}
    assert follower.reports == [("ERROR", "No room")]
    assert clean(context, follower)


def test_a_defect_leaves_nothing_behind(context, window):
    follower = Follower(FakeRun(steps=1))
    follower.follow(context)
    follower.run.progress = lambda: 1 / 0
    with pytest.raises(ZeroDivisionError):
        follower.modal(context, TIMER)
    assert clean(context, follower)


def test_a_run_that_cannot_begin(context, window):
    follower = Follower("No camera")
    assert follower.follow(context) == {"CANCELLED"}
    assert follower.wait(context) == {"CANCELLED"}
    assert follower.reports == [("ERROR", "No camera")] * 2
    assert context.window_manager.timers == 0
    assert follower.is_idle()


def test_without_a_window_it_is_waited_for(context):
    follower = Follower(FakeRun(steps=2, result=7))
    assert follower.follow(context) == {"FINISHED"}
    assert follower.results == [7]
    assert context.window_manager.shown == ["begin", 50.0, 100.0, "end"]
    assert follower.run.closed == 1
