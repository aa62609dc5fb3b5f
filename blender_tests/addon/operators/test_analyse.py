# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, panels and subcommands of the analysis."""

import json
from types import SimpleNamespace

import bpy
import pytest

from addon.command.main import main
from addon.material.node import new_material
from addon.operators.analyse import last_analysis

from ..analysis.analysis_support import image, textured
from ..support import small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")

SMOOTH, ROUGH = {"Roughness": 0.1}, {"Roughness": 0.85}


@pytest.fixture
def scene(registered):
    """A scene with a sphere of smooth metal and one of rough metal, both in Walk."""
    found, sphere = small_scene(osl=True)
    sphere.location.x = -1.1
    sphere.data.materials.append(new_material("CONDUCTOR", "Smooth", Quality="Walk", **SMOOTH))
    other = sphere.copy()
    other.data = sphere.data.copy()
    other.location.x = 1.1
    other.data.materials[0] = new_material("CONDUCTOR", "Rough", Quality="Walk", **ROUGH)
    found.collection.objects.link(other)
    bpy.context.view_layer.update()
    return found


def quality(name: str) -> int:
    tree = bpy.data.materials[name].node_tree
    return next(n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup").inputs["Quality"]


def test_analysing_changes_nothing(scene) -> None:
    assert bpy.ops.microbounce.analyse() == {"FINISHED"}
    report = last_analysis(bpy.context)
    assert {row.name: row.proposal.then.quality for row in report.rows} == {
        "Smooth": "Single",
        "Rough": "Fitted",
    }
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [2, 2]
    assert 0.0 < report.time_ratio < 1.0
    assert all(0.01 < row.proposal.share < 0.5 for row in report.rows)


def test_it_can_be_ended_before_its_end(scene) -> None:
    """As Esc does; where there is no window it is waited for."""
    from addon.analysis.analyse import analysis_pieces

    pieces = analysis_pieces(bpy.context, 0.01)
    assert [next(pieces) for _ in range(4)] == [0.0, 0.0, 0.0, 1 / 64]
    pieces.close()
    assert bpy.ops.microbounce.analyse("INVOKE_DEFAULT") == {"FINISHED"}
    assert len(last_analysis(bpy.context).changes) == 2


def test_images_without_time_count_as_anything(scene, monkeypatch) -> None:
    """What is proposed so can be applied all the same."""
    from addon.operators import analyse

    made = image(0.1, 0.2)
    for name in ("Smooth", "Rough"):
        node = quality(name).node
        tree = node.id_data
        tree.links.new(textured(tree, made), node.inputs["Roughness"])
    monkeypatch.setattr(analyse, "_SECONDS", 0.0)
    bpy.ops.microbounce.analyse()
    for row in last_analysis(bpy.context).rows:
        assert row.notes[0].endswith("there was no time to read the image 'Slope'")
        assert row.proposal.then.quality == "Fitted"
    bpy.ops.microbounce.apply_analysis()
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [1, 1]


def test_applying_and_undoing(scene) -> None:
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.microbounce.analyse()
    assert bpy.ops.microbounce.apply_analysis("EXEC_DEFAULT", True) == {"FINISHED"}
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [0, 1]
    bpy.ops.ed.undo()
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [2, 2]


def test_analysing_after_applying_proposes_nothing(scene) -> None:
    bpy.ops.microbounce.analyse()
    bpy.ops.microbounce.apply_analysis()
    bpy.ops.microbounce.analyse()
    assert last_analysis(bpy.context).changes == ()
    assert not bpy.ops.microbounce.apply_analysis.poll()


def test_what_changed_since_is_left(scene) -> None:
    bpy.ops.microbounce.analyse()
    quality("Smooth").default_value = 3
    bpy.ops.microbounce.apply_analysis()
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [3, 1]
    with pytest.raises(RuntimeError, match="Changed since the analysis: Rough, Smooth"):
        bpy.ops.microbounce.apply_analysis()


def test_a_proposal_for_another_surface_is_left(scene, capfd) -> None:
    """What is proposed for smooth metal would be far off once it is rough."""
    bpy.ops.microbounce.analyse()
    quality("Smooth").node.inputs["Roughness"].default_value = 1.0
    assert bpy.ops.microbounce.apply_analysis() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "1 set. Changed since the analysis and left: Smooth. Analyse again" in said
    assert [quality(name).default_value for name in ("Smooth", "Rough")] == [2, 1]
    bpy.ops.microbounce.analyse()
    assert bpy.ops.microbounce.apply_analysis() == {"FINISHED"}
    assert quality("Smooth").default_value == 1


def test_what_is_driven_is_told_and_left(scene) -> None:
    quality("Smooth").driver_add("default_value")
    bpy.ops.microbounce.analyse()
    rows = {row.name: row.proposal for row in last_analysis(bpy.context).rows}
    assert rows["Smooth"].reason == "Quality has a driver or is animated: it stays"
    assert not rows["Smooth"].changes
    bpy.ops.microbounce.apply_analysis()
    assert quality("Rough").default_value == 1


def test_materials_of_a_library_are_told_and_left(scene, tmp_path) -> None:
    path = tmp_path / "library.blend"
    bpy.data.libraries.write(str(path), {bpy.data.materials["Smooth"]})
    with bpy.data.libraries.load(str(path), link=True) as (_, target):
        target.materials = ["Smooth"]
    linked = target.materials[0]
    assert linked.library is not None
    bpy.data.materials["Smooth"].user_remap(linked)
    bpy.ops.microbounce.analyse()
    rows = {row.name: row.proposal for row in last_analysis(bpy.context).rows}
    assert rows["Smooth"].reason == "It is linked from a library: it stays"
    bpy.ops.microbounce.apply_analysis()
    assert quality("Rough").default_value == 1


def test_an_empty_scene(registered) -> None:
    with pytest.raises(RuntimeError, match="no analysis of this scene"):
        bpy.ops.microbounce.apply_analysis()
    assert bpy.ops.microbounce.analyse() == {"FINISHED"}
    report = last_analysis(bpy.context)
    assert (report.rows, report.error_now, report.time_ratio) == ((), 0.0, 1.0)


def test_without_a_camera(scene) -> None:
    scene.camera = None
    bpy.ops.microbounce.analyse()
    report = last_analysis(bpy.context)
    assert not report.has_camera
    assert [row.proposal.share for row in report.rows] == [0.5, 0.5]


def test_the_tolerance_decides(scene) -> None:
    """Rough metal may be a single bounce where anything will do."""
    bpy.ops.microbounce.analyse(tolerance=1.0)
    assert {row.proposal.then.quality for row in last_analysis(bpy.context).rows} == {"Single"}
    bpy.ops.microbounce.analyse()
    assert last_analysis(bpy.context).tolerance == pytest.approx(0.01)


def test_the_preferences_tolerance_counts_unless_one_is_given(scene, stored) -> None:
    stored.tolerance = 0.25
    bpy.ops.microbounce.analyse()
    assert last_analysis(bpy.context).tolerance == 0.25
    bpy.ops.microbounce.analyse(tolerance=0.5)
    assert last_analysis(bpy.context).tolerance == 0.5


def test_a_report_belongs_to_its_file_and_scene(scene) -> None:
    bpy.ops.microbounce.analyse()
    bpy.context.window.scene = bpy.data.scenes.new("Other") if bpy.context.window else None
    assert last_analysis(bpy.context) is None


class Layout:
    """Takes what a panel draws and keeps the texts."""

    def __init__(self, texts: list[str]) -> None:
        self.texts = texts

    def __getattr__(self, name: str):
        def draw(*arguments, **options):
            self.texts += [options["text"]] if "text" in options else []
            return self

        return draw


def test_the_panel_shows_the_table(scene) -> None:
    from addon.ui.analyse import draw_analysis

    texts: list[str] = []
    bpy.ops.microbounce.analyse()
    context = SimpleNamespace(
        window_manager=bpy.context.window_manager,
        scene=bpy.context.scene,
        preferences=bpy.context.preferences,
        region=SimpleNamespace(width=2000),
    )
    draw_analysis(Layout(texts), context)
    assert "Walk, 16 bounces to Single" in texts
    assert any("further bounces carry" in text for text in texts)
    assert any(text.startswith("Picture: ") for text in texts)
    assert any(text.startswith("Time of a sample: 0.") for text in texts)


@pytest.fixture
def file(scene, tmp_path):
    """The scene as a file."""
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_the_command_analyses(file, capfd) -> None:
    assert main(["analyse", "--file", str(file), "--json"]) == 1
    data = json.loads(capfd.readouterr().out)
    assert {row["material"]: row["then"]["quality"] for row in data["materials"]} == {
        "Smooth": "Single",
        "Rough": "Fitted",
    }
    rough = next(row for row in data["materials"] if row["material"] == "Rough")
    assert [step["quality"] for step in rough["steps"]] == ["Single", "Fitted", "Walk", "Exact"]
    single, fitted = rough["steps"][:2]
    assert fitted["error"] == rough["error_then"]
    assert single["picture_error"] == pytest.approx(
        single["error"] * rough["share"] ** 0.5, abs=2e-4
    )
    assert single["energy_lost"] > 0.3
    assert fitted["time"] > 0.9 * single["time"]
    assert main(["analyse", "--file", str(file)]) == 1
    told = capfd.readouterr().out
    assert "further bounces carry" in told
    for step in ("Single", "Fitted", "Walk", "Exact"):
        assert told.count(f"\n        {step}") == 2


def test_the_command_applies_to_another_file(file, tmp_path, capfd) -> None:
    target = tmp_path / "fast.blend"
    before = file.read_bytes()
    assert main(["apply", "--file", str(file), "--save-as", str(target), "--json"]) == 0
    data = json.loads(capfd.readouterr().out)
    assert sorted(data["set"]) == ["Rough", "Smooth"]
    assert data["saved"] == str(target)
    assert file.read_bytes() == before
    assert main(["analyse", "--file", str(target)]) == 0


def test_the_command_tells_where_no_choice_is_enough(file, tmp_path, capfd) -> None:
    """Both subcommands: whether a change is proposed or not."""
    target = tmp_path / "best.blend"
    arguments = ["--tolerance", "0.0001"]
    assert main(["apply", "--file", str(file), *arguments, "--save-as", str(target)]) == 1
    told = capfd.readouterr().out
    assert "No choice of steps is within the tolerance of 0.01 %: " in told
    assert " % are left" in told
    assert main(["analyse", "--file", str(target), *arguments, "--json"]) == 1
    data = json.loads(capfd.readouterr().out)
    assert not data["within_tolerance"]
    assert not any(row["changes"] for row in data["materials"])


def test_bad_tolerances(file, capfd) -> None:
    for tolerance in ("0", "-1", "2", "nan"):
        assert main(["analyse", "--file", str(file), f"--tolerance={tolerance}"]) == 2
        assert "give a number above 0" in capfd.readouterr().err
