# SPDX-License-Identifier: GPL-3.0-or-later
"""When the check before rendering runs and speaks, and that it changes nothing."""

import time

import pytest

from addon.core.finding import Finding
from addon.core.kinds import KINDS
from blender_tests.addon.support import give_material, render, small_scene, sphere


def snapshot():
    """Names and users of all that the file holds, and the settings that the check looks at."""
    import bpy

    kinds = (bpy.data.materials, bpy.data.node_groups, bpy.data.texts, bpy.data.objects)
    held = [[(item.name, item.users) for item in found] for found in kinds]
    scene = bpy.context.scene
    return held, scene.cycles.shading_system, scene.render.engine


def test_a_render_prints_what_was_found_once(osl_scene, tmp_path, capfd):
    give_material()
    osl_scene.cycles.shading_system = False
    before = snapshot()
    said = []
    for _ in range(2):
        render(tmp_path / "picture.exr")
        said.append([s for s in capfd.readouterr().out.splitlines() if "Microbounce" in s])
    assert said[0] == [
        "Microbounce: Warning: Scene 'Scene': Open Shading Language is off; Cycles' own "
        "material shows. Switch it on in the render properties."
    ]
    assert said[1] == [], "it was told before"
    assert snapshot() == before
    osl_scene.cycles.shading_system = True
    render(tmp_path / "picture.exr")
    osl_scene.cycles.shading_system = False
    render(tmp_path / "picture.exr")
    assert capfd.readouterr().out.count("Open Shading Language is off") == 1, "it is news again"


def test_a_render_without_our_materials_says_nothing(osl_scene, tmp_path, capfd):
    osl_scene.cycles.shading_system = False
    render(tmp_path / "picture.exr")
    assert "Microbounce" not in capfd.readouterr().out


def test_a_failing_check_is_told_and_the_render_goes_on(osl_scene, tmp_path, capfd, monkeypatch):
    from addon.scene import before_render

    def fail(*_):
        raise ReferenceError("StructRNA of type Material has been removed")

    give_material()
    monkeypatch.setattr(before_render, "check_scene", fail)
    capfd.readouterr()
    assert render(tmp_path / "picture.exr").max() > 0.1
    said = capfd.readouterr().err
    assert "the check before rendering failed (ReferenceError: StructRNA" in said
    assert "Traceback" not in said


def test_the_handler_outlives_a_new_file(registered, tmp_path, capfd):
    small_scene(osl=False)
    give_material()
    render(tmp_path / "picture.exr")
    assert "Open Shading Language is off" in capfd.readouterr().out


def test_operator_reports_and_the_panel_shows(osl_scene, capfd):
    import bpy

    from addon.scene.before_render import last_render_findings

    check_render = bpy.ops.microbounce.check_render
    assert check_render() == {"FINISHED"}
    assert "No Microbounce material is rendered" in capfd.readouterr().out
    assert last_render_findings(osl_scene) is None
    material = give_material()
    check_render()
    assert "will render as they should" in capfd.readouterr().out
    assert last_render_findings(osl_scene) == ()
    node = material.node_tree.nodes["Microbounce Conductor"]
    node.node_tree["microbounce_stamp"] = "older"
    osl_scene.cycles.shading_system = False
    check_render()
    said = capfd.readouterr().out
    assert "Warning: Scene 'Scene': Open Shading Language is off" in said
    assert "Info: Material 'Ours': Another version" in said
    levels = [finding.level for finding in last_render_findings(osl_scene)]
    assert levels == ["warning", "note"]
    sphere().data.materials.clear()
    check_render()
    assert last_render_findings(osl_scene) is None


def test_findings_end_with_the_registration(osl_scene):
    import addon
    from addon.scene.before_render import last_render_findings, remember

    assert remember(osl_scene, (Finding("note", "Scene 'Scene'", "Well."),))
    addon.unregister()
    assert last_render_findings(osl_scene) is None
    addon.register()


@pytest.mark.nightly
@pytest.mark.timing
def test_it_is_quick(osl_scene, report):
    """A third of it is reading the bytecode of three kinds, 3 MB, to see that it is there."""
    import bpy

    from addon.material.node import new_material
    from addon.scene.before_render import check_scene

    for number in range(100):
        kind = list(KINDS)[number % len(KINDS)]
        obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
        obj.data.materials.append(new_material(kind, "Ours"))
        osl_scene.collection.objects.link(obj)
    times = []
    for _ in range(10):
        start = time.process_time()
        assert check_scene(osl_scene, bpy.context.preferences) == ()
        times.append(1e3 * (time.process_time() - start))
    report("check before rendering, 100 materials", f"{min(times):.1f} ms", "10 ms")
    assert min(times) < 10.0
