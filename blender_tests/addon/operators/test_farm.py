# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator and the panels of the check for a farm."""

from types import SimpleNamespace

import pytest

from blender_tests.addon.operators.fake_run import FakeRun
from blender_tests.addon.support import small_scene
from blender_tests.addon.ui.test_panels import Record

pytestmark = pytest.mark.usefixtures("compiled_once")

PANELS = ("MICROBOUNCE_PT_farm_material", "MICROBOUNCE_PT_farm_shader_editor")


@pytest.fixture
def scene(registered):
    """A scene with our matte material; returns bpy."""
    from addon.material.node import new_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material("DIFFUSE", "Ours"))
    return registered


def draw(bpy, panel):
    system = SimpleNamespace(ui_scale=1.0)
    context = SimpleNamespace(
        scene=bpy.context.scene,
        region=SimpleNamespace(width=400),
        preferences=SimpleNamespace(system=system),
    )
    record = Record()
    getattr(bpy.types, panel).draw(SimpleNamespace(layout=record), context)
    return record


def last(bpy):
    from addon.operators.farm import last_farm_findings

    return last_farm_findings(bpy.context.scene)


@pytest.mark.parametrize("panel", PANELS)
def test_panels_offer_the_check_and_show_what_it_found(scene, panel):
    record = draw(scene, panel)
    assert record.operators == ["check_farm", "check_farm"]
    assert record.buttons[1].prove is True
    assert record.texts == []
    assert scene.ops.microbounce.check_farm() == {"FINISHED"}
    assert draw(scene, panel).texts == ["Nothing was found"]
    scene.context.scene.cycles.shading_system = False
    assert draw(scene, panel).texts == ["Nothing was found"], "drawing checks nothing"
    assert scene.ops.microbounce.check_farm() == {"FINISHED"}
    record = draw(scene, panel)
    assert "Scene 'Scene': Open Shading Language is off" in record.text
    assert "Switch it on" in record.text


def test_findings_are_not_taken_for_those_of_another_file(scene, tmp_path):
    scene.context.scene.cycles.shading_system = False
    scene.ops.microbounce.check_farm()
    assert [finding.level for finding in last(scene)] == ["error"]
    path = str(tmp_path / "scene.blend")
    scene.ops.wm.save_as_mainfile(filepath=path)
    scene.ops.wm.open_mainfile(filepath=path)
    assert last(scene) is None
    scene.ops.wm.read_factory_settings(use_empty=True)
    assert last(scene) is None


def test_the_check_changes_nothing(scene):
    def state():
        data = scene.data
        names = [[block.name for block in getattr(data, kind)] for kind in ("texts", "materials")]
        return names, scene.context.scene.cycles.shading_system, list(scene.context.scene.keys())

    scene.context.scene.cycles.shading_system = False
    before = state()
    scene.ops.microbounce.check_farm()
    assert state() == before


def test_an_empty_file_is_ready(registered):
    assert registered.ops.microbounce.check_farm() == {"FINISHED"}
    assert last(registered) == ()


def test_the_proof_wants_a_saved_file(scene):
    with pytest.raises(RuntimeError, match="save it first"):
        scene.ops.microbounce.check_farm(prove=True)
    assert last(scene) is None


def test_the_proof_of_the_operator(scene, tmp_path, monkeypatch):
    from addon.farm import proof

    path = tmp_path / "scene.blend"
    scene.ops.wm.save_as_mainfile(filepath=str(path))
    different = proof.Proof(difference=0.5, brightness=1.0, seconds=1.0)
    run = FakeRun(steps=2, result=different)
    asked = []
    monkeypatch.setattr(proof, "ProofRun", lambda file: asked.append(file) or run)
    assert scene.ops.microbounce.check_farm(prove=True) == {"FINISHED"}
    assert asked == [path]
    assert run.closed == 1
    (found,) = last(scene)
    assert "50.0% of the light" in found.message


def test_tooltips_tell_the_two_buttons_apart(registered):
    from addon.operators.farm import MICROBOUNCE_OT_check_farm as operator

    texts = [operator.description(None, SimpleNamespace(prove=prove)) for prove in (False, True)]
    assert texts[0] == "", "Blender then shows the operator's own"
    assert texts[1].startswith("Also render")
    assert not texts[1].endswith(".")
