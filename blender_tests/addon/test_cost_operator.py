# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator runs through in scripts and step by step in a window; the panel shows both."""

from types import SimpleNamespace

import bpy
import pytest

from addon.core.cost.plan import Options
from addon.nodes.cost import run
from addon.nodes.cost.run import CostError, Progress
from addon.ops.cost import MICROBOUNCE_OT_measure_cost, State
from addon.ui.cost import MICROBOUNCE_PT_cost, MICROBOUNCE_PT_cost_options
from blender_tests.addon.cost_support import dump, measured, report, tiny_scene

REPORT = report(measured("fitted", bias=0.01), measured("exact", se=0.1)).as_dict()


@pytest.fixture(autouse=True)
def scene(registered, compiled_once):
    """A tiny scene, and no report of another test."""
    yield tiny_scene()
    State.progress = State.report = None


@pytest.fixture
def shown(monkeypatch):
    """Do not draw the plot."""
    monkeypatch.setattr(run, "load_plot", lambda report: None)


class _Run:
    """Stands for a measurement that is under way."""

    def __init__(self, result=REPORT, states=2):
        self._result, self._states, self.closed = result, states, 0

    @property
    def running(self):
        self._states -= 1
        return self._states >= 0

    def progress(self):
        return Progress(0.5, "Fitted, round 1 of 3", 65.0)

    def result(self):
        if isinstance(self._result, Exception):
            raise self._result
        return self._result

    def close(self):
        self.closed += 1


class _Steps:
    """The operator as Blender would call it from a window's timer."""

    def __init__(self, measurement):
        State.progress = measurement.progress()
        self.told, self.calls = [], []
        manager = SimpleNamespace(
            windows=[],
            event_timer_remove=lambda timer: self.calls.append("timer"),
            progress_update=lambda value: self.calls.append(value),
            progress_end=lambda: self.calls.append("end"),
        )
        status = SimpleNamespace(status_text_set=lambda text: self.calls.append(text))
        self._context = SimpleNamespace(window_manager=manager, workspace=status)
        self._self = SimpleNamespace(
            _run=measurement, _timer=None, report=lambda kind, text: self.told.append((kind, text))
        )
        for name in ("cancel", "_finish", "_show_progress"):
            method = getattr(MICROBOUNCE_OT_measure_cost, name)
            setattr(self._self, name, method.__get__(self._self))

    def __call__(self, kind="TIMER", value="NOTHING"):
        event = SimpleNamespace(type=kind, value=value)
        return MICROBOUNCE_OT_measure_cost.modal(self._self, self._context, event)

    def quit(self):
        """Load another file, or leave Blender."""
        self._context.workspace = None
        MICROBOUNCE_OT_measure_cost.cancel(self._self, self._context)


def test_step_by_step_to_the_end(shown):
    measurement = _Run()
    step = _Steps(measurement)
    assert step("MOUSEMOVE") == {"PASS_THROUGH"}
    assert step() == step() == {"PASS_THROUGH"}
    assert not MICROBOUNCE_OT_measure_cost.poll(bpy.context), "one at a time"
    assert step() == {"FINISHED"}
    assert 50.0 in step.calls
    assert step.calls[-3:] == ["timer", "end", None]
    assert step.told == [({"INFO"}, "A sentence.")]
    assert (State.report, State.progress, measurement.closed) == (REPORT, None, 1)
    assert MICROBOUNCE_OT_measure_cost.poll(bpy.context)


def test_escape_cancels():
    measurement = _Run()
    step = _Steps(measurement)
    assert step("ESC", "RELEASE") == {"PASS_THROUGH"}
    assert step("ESC", "PRESS") == {"CANCELLED"}
    assert (State.report, State.progress, measurement.closed) == (None, None, 1)
    assert step.told == [({"INFO"}, "Measuring was cancelled")]


def test_an_error_is_told_and_ends_it():
    measurement = _Run(CostError("No light."), states=0)
    step = _Steps(measurement)
    assert step() == {"CANCELLED"}
    assert step.told == [({"ERROR"}, "No light.")]
    assert (State.progress, measurement.closed) == (None, 1)


def test_another_file_ends_it():
    measurement = _Run()
    _Steps(measurement).quit()
    assert (State.progress, measurement.closed) == (None, 1)


def test_scripts_wait_for_it(shown, monkeypatch, scene):
    asked = []

    def fake(scene, layer, options, output):
        asked.append((scene, layer.name, options, output))
        return REPORT

    monkeypatch.setattr(run, "measure", fake)
    before = dump()
    assert bpy.ops.microbounce.measure_cost(
        samples=8, steps="walk, fitted", bounces="", kernels="0.2", error=5.0, output="//here"
    ) == {"FINISHED"}
    options = Options(samples=8, steps=("Fitted", "Walk"), bounces=(), kernels=(0.2,), error=0.05)
    assert asked == [(scene, "ViewLayer", options, "//here")]
    assert State.report is REPORT
    assert dump() == before


def test_what_is_offered_is_what_the_command_offers(monkeypatch, shown):
    asked = []
    monkeypatch.setattr(run, "measure", lambda *arguments: asked.append(arguments) or REPORT)
    bpy.ops.microbounce.measure_cost()
    assert asked[0][2] == Options()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"steps": "best"}, "Step cannot be Best"),
        ({"bounces": "one"}, "'one' is no number"),
        ({"samples": 1}, "Samples cannot be 1"),
    ],
)
def test_wrong_options(options, message):
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.microbounce.measure_cost(**options)
    assert State.progress is None


def test_not_without_a_camera(scene):
    scene.camera = None
    with pytest.raises(RuntimeError, match="The scene has no camera: add one"):
        bpy.ops.microbounce.measure_cost()


def test_the_cache_is_cleared(monkeypatch, tmp_path):
    from addon.nodes.cost import reference_cache

    monkeypatch.setattr(reference_cache, "cache_folder", lambda: tmp_path / "cache")
    (tmp_path / "cache").mkdir()
    (tmp_path / "cache" / "a.npz").touch()
    assert bpy.ops.microbounce.clear_cost_cache() == {"FINISHED"}
    assert not (tmp_path / "cache").exists()
    (tmp_path / "cache").touch()
    with pytest.raises(RuntimeError, match="cannot be removed"):
        bpy.ops.microbounce.clear_cost_cache()


class _Layout:
    """Notes what a panel draws."""

    def __init__(self):
        self.texts, self.operators, self.props = [], [], []

    def label(self, text="", icon="NONE"):
        self.texts.append(text)

    def progress(self, factor, text):
        self.texts.append(text)

    def prop(self, data, name):
        assert hasattr(data, name)
        self.props.append(name)

    def operator(self, name, text="", icon="NONE"):
        self.operators.append((name, SimpleNamespace()))
        return self.operators[-1][1]

    def _same(self, **options):
        return self

    box = column = row = grid_flow = _same


def _drawn(panel):
    layout = _Layout()
    context = SimpleNamespace(
        window_manager=bpy.context.window_manager,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(width=300),
    )
    panel.draw(SimpleNamespace(layout=layout), context)
    return layout


def test_the_panel_hands_its_options_to_the_button():
    options = bpy.context.window_manager.microbounce_cost
    options.samples = 5
    layout = _drawn(MICROBOUNCE_PT_cost)
    [(name, button)] = layout.operators
    assert (name, button.samples, button.steps) == ("microbounce.measure_cost", 5, options.steps)
    assert set(_drawn(MICROBOUNCE_PT_cost_options).props) == set(vars(button))


def test_the_panel_shows_progress():
    State.progress = Progress(0.5, "Fitted, round 1 of 3", 65.0)
    layout = _drawn(MICROBOUNCE_PT_cost)
    assert layout.texts == ["50 %, 65 s left", "Fitted, round 1 of 3", "Esc cancels"]
    assert layout.operators == []


def test_the_panel_shows_the_last_result():
    State.report = REPORT
    layout = _drawn(MICROBOUNCE_PT_cost)
    assert layout.texts[:2] == ["a<b.blend, frame 3", "A sentence."]
    assert layout.texts[2:6] == ["Variant", "To 2 %", "Bias", "Noise"]
    assert layout.texts[6:10] == ["Exact", "25 s ?", "< 55 %", "10 %"]
    assert layout.texts[10:14] == ["Fitted", "33 s", "1 %", "10 %"]
    assert [o.filepath for name, o in layout.operators if name == "wm.path_open"] == [
        "cost.html",
        ".",
    ]


def test_the_panel_is_for_cycles(scene):
    assert MICROBOUNCE_PT_cost.poll(SimpleNamespace(engine="CYCLES"))
    assert not MICROBOUNCE_PT_cost.poll(SimpleNamespace(engine="BLENDER_WORKBENCH"))
