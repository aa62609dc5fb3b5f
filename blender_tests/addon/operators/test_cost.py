# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator runs through in scripts; the panel shows how far it is and what came of it."""

import argparse
from types import SimpleNamespace

import bpy
import pytest

from addon.command.cost import add_arguments
from addon.core.cost.options import OPTIONS, options_of
from addon.core.cost.plan import Options
from addon.core.cost.results import TOO_SHORT
from addon.core.run import Progress
from addon.cost import run
from addon.operators import cost
from addon.operators.cost import MICROBOUNCE_OT_measure_cost, last_measurement
from addon.ui.cost import MICROBOUNCE_PT_cost, MICROBOUNCE_PT_cost_options
from blender_tests.addon.cost.cost_support import dump, measured, report, tiny_scene
from blender_tests.addon.operators.fake_run import FakeRun

REPORT = report(measured("fitted", bias=0.01), measured("exact", se=0.1)).as_dict()


@pytest.fixture(autouse=True)
def scene(registered, compiled_once):
    """A tiny scene, and no report of another test."""
    return tiny_scene()


@pytest.fixture
def asked(monkeypatch):
    """What CostRun is asked for; it finds REPORT, whose plot is not drawn."""
    found = []

    def begin(*arguments):
        found.append(arguments)
        return FakeRun(steps=1, result=REPORT)

    monkeypatch.setattr(run, "CostRun", begin)
    return found


def test_scripts_wait_for_it(asked, scene):
    before = dump()
    assert last_measurement() is None
    assert bpy.ops.microbounce.measure_cost(
        samples=8, steps="walk, fitted", bounces="", kernels="0.2", error=5.0, output="//here"
    ) == {"FINISHED"}
    options = Options(samples=8, steps=("Fitted", "Walk"), bounces=(), kernels=(0.2,), error=0.05)
    ((wanted, layer, found, folder),) = asked
    assert (wanted, layer.name, found, folder) == (scene, "ViewLayer", options, "//here")
    assert last_measurement() is REPORT
    assert dump() == before


def test_what_is_offered_is_what_the_command_offers(asked):
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
    assert last_measurement() is None


def test_not_without_a_camera(scene):
    scene.camera = None
    with pytest.raises(RuntimeError, match="The scene has no camera: add one"):
        bpy.ops.microbounce.measure_cost()


def test_the_cache_is_cleared(monkeypatch, tmp_path):
    from addon.cost import reference_cache

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


def test_properties_and_arguments_are_the_options():
    """The operator, the panel's properties and the subcommand offer the same, by default too."""
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    given = vars(parser.parse_args([]))
    given |= {"output": given["folder"], "reference": given["reference"].upper()}
    assert options_of(given) == Options()
    properties = bpy.ops.microbounce.measure_cost.get_rna_type().properties
    panel = bpy.context.window_manager.microbounce_cost.bl_rna.properties
    for option in OPTIONS:
        assert given[option.name] == ("none" if option.default == "" else option.default)
        for found in (properties[option.name], panel[option.name]):
            assert (found.name, found.description) == (option.label, option.help)
            assert found.default == pytest.approx(option.default)
            if found.type in ("INT", "FLOAT"):
                assert (found.hard_min, found.hard_max) == pytest.approx(option.limits)
                assert found.subtype == ("PERCENTAGE" if option.percent else "NONE")


def test_the_panel_hands_its_options_to_the_button():
    options = bpy.context.window_manager.microbounce_cost
    options.samples = 5
    layout = _drawn(MICROBOUNCE_PT_cost)
    [(name, button)] = layout.operators
    assert (name, button.samples, button.steps) == ("microbounce.measure_cost", 5, options.steps)
    assert set(_drawn(MICROBOUNCE_PT_cost_options).props) == set(vars(button))


def test_the_panel_shows_progress(monkeypatch):
    now = Progress(0.5, "Fitted, round 1 of 3", 65.0)
    monkeypatch.setattr(MICROBOUNCE_OT_measure_cost, "progress", now)
    assert not MICROBOUNCE_OT_measure_cost.poll(bpy.context), "one at a time"
    layout = _drawn(MICROBOUNCE_PT_cost)
    assert layout.texts == ["50 %, 65 s left", "Fitted, round 1 of 3", "Esc cancels"]
    assert layout.operators == []


def test_the_panel_shows_the_last_result(asked):
    bpy.ops.microbounce.measure_cost()
    layout = _drawn(MICROBOUNCE_PT_cost)
    assert layout.texts[:2] == ["a<b.blend, frame 3", "A sentence."]
    assert layout.texts[2:6] == ["Variant", "To 2 %", "Bias", "Noise"]
    assert layout.texts[6:10] == ["Exact", "25 s ?", "< 55 %", "10 %"]
    assert layout.texts[10:14] == ["Fitted", "33 s", "1 %", "10 %"]
    assert "microbounce.show_cost_plot" in [name for name, _ in layout.operators]
    assert [o.filepath for name, o in layout.operators if name == "wm.path_open"] == [
        "cost.html",
        ".",
    ]


def test_a_time_that_is_none_is_not_shown(asked, monkeypatch):
    quick = report(measured("walk", seconds=16 * TOO_SHORT)).as_dict()
    monkeypatch.setattr(run, "CostRun", lambda *arguments: FakeRun(steps=1, result=quick))
    bpy.ops.microbounce.measure_cost()
    assert _drawn(MICROBOUNCE_PT_cost).texts[6:8] == ["Walk", "too short"]


@pytest.fixture
def plotted(asked, monkeypatch, tmp_path):
    """A measurement whose plot is a file; returns the file."""
    path = tmp_path / "cost.svg"
    path.write_text("<svg/>")
    monkeypatch.setattr(cost, "_last", {"files": {"plot": str(path)}})
    return path


def test_the_plot_is_opened(plotted, monkeypatch, tmp_path):
    opener = tmp_path / "xdg-open"
    opener.write_text('#!/bin/sh\necho "$1" > "$0.log"\n')
    opener.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    assert bpy.ops.microbounce.show_cost_plot() == {"FINISHED"}
    assert (tmp_path / "xdg-open.log").read_text().strip() == str(plotted)


def test_there_may_be_no_plot(plotted, monkeypatch):
    plotted.unlink()
    with pytest.raises(RuntimeError, match=r"cost\.svg is gone: measure again"):
        bpy.ops.microbounce.show_cost_plot()
    monkeypatch.setattr(cost, "_last", None)
    with pytest.raises(RuntimeError, match="There is no plot: press Measure Cost first"):
        bpy.ops.microbounce.show_cost_plot()


def test_the_panel_is_for_cycles(scene):
    assert MICROBOUNCE_PT_cost.poll(SimpleNamespace(engine="CYCLES"))
    assert not MICROBOUNCE_PT_cost.poll(SimpleNamespace(engine="BLENDER_WORKBENCH"))
