# SPDX-License-Identifier: GPL-3.0-or-later
"""A measurement in a Blender of its own: what it finds, and that the open file stays as it is."""

import json
import os
import subprocess
import time
from pathlib import Path

import bpy
import pytest

from addon import child_blender
from addon.core.cost.plan import Options
from addon.cost import reference_cache, run
from addon.cost.run import CostError, CostRun, measure
from blender_tests.addon.cost.cost_support import dump, tiny_scene
from blender_tests.addon.support import small_scene

# Seven renders of 24 pixels.
QUICK = Options(
    samples=4,
    percentage=0,
    steps=("Fitted",),
    bounces=(),
    baselines=False,
    rounds=2,
    reference_samples=8,
)


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path, registered, compiled_once):
    """Temporary files and the cache go into a folder of the test."""
    monkeypatch.setattr(run.tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(reference_cache, "cache_folder", lambda: tmp_path / "cache")
    return tmp_path


def _measure(scene, options=QUICK, output="//report", **arguments):
    return measure(scene, scene.view_layers[0], options, output, **arguments)


def test_a_tiny_scene_from_end_to_end(folder):
    scene = tiny_scene(folder / "tiny.blend")
    scene.render.use_border, scene.render.border_max_x = True, 0.5
    before, told = dump(), []
    report = _measure(scene, tell=told.append)
    assert dump() == before
    assert list((folder / "temporary").iterdir()) == []
    assert not (folder / "cache").exists(), "the border may have been set after saving"
    row, setting = report["variants"][0], report["setting"]
    assert (row["key"], row["samples"], setting["rounds"]) == ("fitted", 4, 2)
    assert (setting["width"], setting["height"]) == (12, 24)
    assert (setting["file"], setting["reference_samples"]) == ("tiny.blend", 8)
    for key in ("seconds", "processor_seconds"):  # so few samples may be too short to be timed
        assert row[key] > 0.0 if row["timed"] else row[key] is None
    assert row["noise"] > 0.0
    assert row["memory_mb"] > 0.0
    assert "unsaved changes" in " ".join(setting["notes"])
    assert [p.text for p in told if p.part == 1.0][-1] == "Writing the report"
    assert [p.part for p in told] == sorted(p.part for p in told)
    files = {Path(path) for path in report["files"].values()}
    assert files == set((folder / "report").iterdir())
    assert json.loads((folder / "report" / "cost.json").read_text("utf-8")) == report
    assert (folder / "report" / "cost.svg").read_text("utf-8").startswith("<svg")


def test_linked_materials_and_osl_switched_off(folder):
    tiny_scene(folder / "library.blend")
    scene, sphere = small_scene(osl=False)
    scene.render.resolution_x = scene.render.resolution_y = 16
    with bpy.data.libraries.load(str(folder / "library.blend"), link=True) as (_, wanted):
        wanted.materials = ["Ours"]
    sphere.data.materials.append(bpy.data.materials["Ours"])
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "user.blend"))
    scene = bpy.context.scene
    library = (folder / "library.blend").read_bytes()
    before = dump()
    options = Options(**QUICK.as_dict() | {"steps": ("Single", "Fitted"), "baselines": True})
    report = _measure(scene, options)
    assert dump() == before
    assert (folder / "library.blend").read_bytes() == library
    rows = {row["key"]: row for row in report["variants"]}
    assert set(rows) == {"single", "fitted", "cycles_osl", "cycles_svm"}
    assert len({row["bias"] + row["noise"] for row in rows.values()}) >= 3, "they differ"
    assert "OSL" in rows["cycles_svm"]["variant"]
    assert any("is off in the scene" in note for note in report["setting"]["notes"])


def test_an_error_in_the_middle_changes_nothing(folder):
    scene = tiny_scene(folder / "dark.blend")
    bpy.data.lights[0].energy, scene.world = 0.0, None
    before = dump()
    with pytest.raises(CostError, match="The reference is black: check camera, lights"):
        _measure(scene)
    assert dump() == before
    assert list((folder / "temporary").iterdir()) == []
    assert not (folder / "report" / "cost.json").exists()


def test_cancelled_in_the_middle(folder):
    scene = tiny_scene(folder / "tiny.blend")
    before = dump()
    options = Options(**QUICK.as_dict() | {"reference_samples": 1_000_000})
    with CostRun(scene, scene.view_layers[0], options, "//report") as started:
        deadline = time.monotonic() + 30.0
        while started.progress().text == "Starting" and time.monotonic() < deadline:
            time.sleep(0.05)
        assert started.advance()
        assert started.progress().text == "Reference, 1 of 2"
        begin = time.monotonic()
    assert time.monotonic() - begin < 3.0
    assert not started.advance()
    assert dump() == before
    assert list((folder / "temporary").iterdir()) == []


def test_an_exception_while_waiting_ends_the_other_blender(folder):
    scene = tiny_scene(folder / "tiny.blend")

    def interrupted(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _measure(scene, tell=interrupted)
    assert list((folder / "temporary").iterdir()) == []


def test_the_other_blender_ends_with_this_one(folder, monkeypatch):
    scene = tiny_scene()
    started = CostRun(scene, scene.view_layers[0], QUICK, str(folder / "report"))
    process = started._child._process
    process.stdin.close()
    assert process.wait(10.0) == 1
    started.close()


def test_no_camera(folder):
    scene = tiny_scene()
    scene.camera = None
    with pytest.raises(CostError, match="has no camera: add one"):
        _measure(scene)
    assert list((folder / "temporary").iterdir()) == []


def test_an_empty_file():
    with pytest.raises(CostError, match="has no camera"):
        _measure(bpy.context.scene)


def test_no_material_of_ours():
    scene, sphere = small_scene(osl=True)
    sphere.data.materials.append(bpy.data.materials.new("Plain"))
    with pytest.raises(CostError, match="uses no Microbounce material: give one to an object"):
        _measure(scene)


def test_a_group_without_bytecode():
    scene = tiny_scene()
    bpy.data.node_groups[0].nodes["Multiple Bounces"].bytecode = ""
    with pytest.raises(CostError, match="holds no compiled shader"):
        _measure(scene)


def test_exact_is_no_reference_for_lights_that_it_misses():
    scene = tiny_scene()
    bpy.ops.object.light_add(type="POINT")
    bpy.context.object.data.shadow_soft_size = 0.0
    with pytest.raises(CostError, match="Exact is no reference here: take Walk"):
        _measure(scene, Options(**QUICK.as_dict() | {"reference": "EXACT"}))


def test_an_output_folder_that_cannot_be_written(folder):
    scene = tiny_scene()
    (folder / "file").write_text("", "utf-8")
    with pytest.raises(CostError, match=r"file/report cannot be written: .*Choose another folder"):
        _measure(scene, output=str(folder / "file" / "report"))


def test_no_room_for_the_copy(folder, monkeypatch):
    scene = tiny_scene()

    def full(folder):
        raise CostError("No copy of the file can be saved: no space. Make room")

    monkeypatch.setattr(run, "_saved_copy", full)
    with pytest.raises(CostError, match="Make room"):
        _measure(scene, output=str(folder / "report"))
    assert list((folder / "temporary").iterdir()) == []


def test_a_blender_that_crashes(folder, monkeypatch):
    scene = tiny_scene()
    start = subprocess.Popen

    def crashing(command, **options):
        return start([command[0], "-c", "import os; os._exit(7)"], **options)

    monkeypatch.setattr(child_blender.subprocess, "Popen", crashing)
    with pytest.raises(CostError, match="The measurement failed: it left with exit code 7"):
        _measure(scene, output=str(folder / "report"))


def test_a_file_that_was_never_saved_writes_beside_temporary_files(folder):
    assert run.output_folder("//report") == folder / "temporary" / "report"
    assert run.output_folder(os.path.join(folder, "here")) == folder / "here"
