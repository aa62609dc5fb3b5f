# SPDX-License-Identifier: GPL-3.0-or-later
"""Samples are timed in interleaved rounds."""

from pathlib import Path

import bpy
import pytest

from scenes.timing import SampleTimes, time_samples

FURNACE = Path(__file__).resolve().parents[2] / "scenes" / "furnace_conductor.blend"


def test_medians_and_ratios_are_taken_round_by_round():
    starts = {"a": [3.0, 1.0, 2.0]}
    times = SampleTimes({"a": [1.0, 2.0, 10.0], "b": [2.0, 6.0, 5.0]}, starts)
    assert times.start("a") == 2.0
    assert times.median("a") == 2.0
    assert times.ratios("b", "a") == [2.0, 3.0, 0.5]
    assert times.ratio("b", "a") == 2.0
    more = times.joined(SampleTimes({"a": [1.0], "b": [3.0]}, {"a": [4.0]}))
    assert more.ratios("b", "a") == [2.0, 3.0, 0.5, 3.0]
    assert more.start("a") == 2.5


@pytest.mark.parametrize("wrong", [{"samples": 0}, {"rounds": 0}])
def test_numbers_below_one_are_refused(wrong):
    with pytest.raises(ValueError, match="1 or more"):
        time_samples(bpy.context.scene, {}, **wrong)


def test_rounds_are_interleaved_and_the_scene_put_back():
    bpy.ops.wm.open_mainfile(filepath=str(FURNACE))
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = 7, 3
    order = []
    switches = {name: lambda name=name: order.append(name) for name in ("a", "b")}
    times = time_samples(scene, switches, samples=64, rounds=2)
    assert order == ["a", "b", "a", "b"]
    assert all(len(times.seconds[name]) == 2 for name in switches)
    assert all(seconds > 0.0 for name in switches for seconds in times.seconds[name])
    assert all(len(times.starts[name]) == 2 for name in switches)
    assert all(start > 0.0 for name in switches for start in times.starts[name])
    assert (scene.cycles.samples, scene.cycles.seed) == (7, 3)
    assert not scene.render.use_persistent_data
