# SPDX-License-Identifier: GPL-3.0-or-later
"""What is keyed or driven does not move away from what a variant sets."""

import bpy
import pytest

from addon.core.cost.plan import Options, planned_variants
from addon.cost import run
from addon.cost.renderer import Renderer, placed_nodes
from addon.cost.run import measure
from blender_tests.addon.cost.cost_support import tiny_scene

SINGLE, WALK, EXACT = "Single", "Walk", "Exact"
VARIANTS = {v.key: v for v in planned_variants(Options())}


@pytest.fixture
def scene(registered, compiled_once, tmp_path):
    """A scene with a white metal in Quality Single."""
    scene = tiny_scene(tmp_path / "still.blend")
    _set(placed_nodes()[0], Quality=SINGLE, Roughness=1.0, BaseColor=(1, 1, 1), EdgeTint=(1, 1, 1))
    return scene


def _set(placed, **values):
    for identifier, value in values.items():
        placed.set(identifier, value)


def _socket(label):
    return placed_nodes()[0].node.inputs[label]


def _key(label, *values):
    """Key the input from frame 1 on, a frame each."""
    for frame, value in enumerate(values, 1):
        _socket(label).default_value = value
        _socket(label).keyframe_insert("default_value", frame=frame)


def _drive(label, expression, by_name=False):
    curve = _socket(label).driver_add("default_value")
    curve.driver.expression = expression
    if by_name:
        name = bpy.utils.escape_identifier(placed_nodes()[0].name)
        curve.data_path = f'nodes["{name}"].inputs["{label}"].default_value'


def _to_strip():
    """Move the keys into a strip of an NLA track."""
    data = placed_nodes()[0].tree.animation_data
    strip = data.nla_tracks.new().strips.new("Keys", 1, data.action)
    strip.action_slot = data.action_slot
    data.action = None
    strip.select = True


def _to_meta_strip():
    """Put the strip into another."""
    _to_strip()
    area = bpy.context.window.screen.areas[0]
    area.type = "NLA_EDITOR"
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=bpy.context.window, area=area, region=region):
        bpy.ops.nla.meta_add()
    assert placed_nodes()[0].tree.animation_data.nla_tracks[0].strips[0].type == "META"


def _ways(label, value):
    """Return the ways to animate an input, by their names."""
    return {
        "keys": lambda: _key(label, value),
        "strip": lambda: (_key(label, value), _to_strip()),
        "meta strip": lambda: (_key(label, value), _to_meta_strip()),
        "driver": lambda: _drive(label, str(value)),
        "driver by name": lambda: _drive(label, str(value), by_name=True),
    }


def _evaluated(label):
    """Return the value that a render sees."""
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)
    placed = placed_nodes()[0]
    tree = placed.tree.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return tree.nodes[placed.name].inputs[label].default_value


@pytest.mark.parametrize("way", list(_ways("", 0)))
def test_a_variant_sets_what_is_animated(scene, tmp_path, way):
    _ways("Quality", 0)[way]()
    assert _evaluated("Quality") == 0
    renderer = Renderer(scene, "ViewLayer", Options(), tmp_path)
    assert renderer.held == ["Quality"]
    for number, step in enumerate(("single", "fitted", "walk", "exact")):
        renderer.show(VARIANTS[step])
        assert _evaluated("Quality") == number, way


def test_what_a_variant_does_not_set_is_as_at_this_frame(scene, tmp_path):
    _key("Max Bounces", 3, 5, 7)
    _key("Roughness", 0.2, 0.4, 0.6)
    scene.frame_set(2)
    _socket("Max Bounces").default_value = 30  # changed and not keyed: no render shows it
    renderer = Renderer(scene, "ViewLayer", Options(), tmp_path)
    renderer.show(VARIANTS["bounces_4"])
    assert _evaluated("Max Bounces") == 4
    renderer.show(VARIANTS["walk"])
    assert _evaluated("Max Bounces") == 5
    assert renderer.held == ["Max Bounces"]
    scene.frame_set(3)
    assert _evaluated("Roughness") == pytest.approx(0.6), "no variant sets it"


def test_only_what_is_asked_for_is_held(scene, tmp_path):
    _drive("Walks", "2")
    _drive("Max Bounces", "6")
    asked = Options(bounces=(), walks=(3,), reference="EXACT")
    _drive("Kernel", "0.2")
    assert Renderer(scene, "ViewLayer", asked, tmp_path).held == ["Walks", "Max Bounces"]
    assert _evaluated("Kernel") == pytest.approx(0.2)


def test_the_measurement_tells_steps_apart_where_quality_is_keyed(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(run.tempfile, "tempdir", str(tmp_path))
    _key("Quality", 0)
    asked = Options(
        samples=16, percentage=0, steps=(SINGLE, WALK), bounces=(), baselines=False, rounds=2
    )
    found = measure(scene, scene.view_layers[0], asked, "//report")
    bias = {row["key"]: row["bias"] for row in found["variants"]}
    assert bias["single"] > 0.2
    assert bias["walk"] < 0.1
    assert "Keyframes and drivers of Quality were off" in " ".join(found["setting"]["notes"])
