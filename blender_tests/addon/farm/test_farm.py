# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: each defect of a shader or a scene has its finding, a clean file none."""

import bpy
import pytest

from blender_tests.addon.farm.farm_scene import OurScene, findings, the_finding
from blender_tests.addon.support import small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def scene(registered):
    """A clean scene with our matte material."""
    return OurScene("DIFFUSE")


def test_a_clean_file_has_no_finding(registered, kind):
    assert findings(OurScene(kind).scene) == []


def test_files_without_our_materials_have_none(registered):
    assert findings(registered.context.scene) == []
    scene, sphere = small_scene(osl=False)
    sphere.data.materials.append(surface_material("Plain")[0])
    sphere.data.materials.append(None)
    assert findings(scene) == []


@pytest.mark.parametrize(
    ("lost", "level", "words"),
    [
        ("bytecode", "error", "but not the hash"),
        ("both", "error", "has no bytecode"),
        ("bytecode_hash", "error", "hash of its bytecode is gone"),
        ("text", "warning", "source is gone"),
        ("script", "error", "script node is gone"),
    ],
)
def test_what_was_taken_out_of_a_group_is_missed(scene, lost, level, words):
    if lost == "text":
        bpy.data.texts.remove(scene.script.script)
    elif lost == "script":
        scene.group.nodes.remove(scene.script)
    else:
        for name in ("bytecode", "bytecode_hash") if lost == "both" else (lost,):
            setattr(scene.script, name, "")
    found = the_finding(scene.scene)
    assert found[:2] == (level, "Node group 'Microbounce Diffuse'")
    assert words in found[2]


def test_an_external_script(scene):
    scene.script.mode = "EXTERNAL"
    level, _, message = the_finding(scene.scene)
    assert level == "error"
    assert "which a farm does not have" in message


def test_a_source_kept_outside_the_file(scene, tmp_path):
    path = tmp_path / "shader.osl"
    path.write_text(scene.script.script.as_string(), encoding="utf-8")
    bytecode, key = scene.script.bytecode, scene.script.bytecode_hash
    scene.script.script = bpy.data.texts.load(str(path))
    scene.script.bytecode, scene.script.bytecode_hash = bytecode, key
    level, _, message = the_finding(scene.scene)
    assert level == "warning"
    assert str(path) in message


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("output float Active = 1", "output float Active = 0.5", "not what its source gives"),
        ("output float Active = 1", "output float Active = (", "does not compile"),
    ],
)
def test_an_edited_source(registered, kind, old, new, words):
    scene = OurScene(kind)
    text = scene.script.script
    source = text.as_string()
    assert old in source
    text.from_string(source.replace(old, new))
    level, _, message = the_finding(scene.scene)
    assert level == "error"
    assert words in message


def test_the_bytecode_of_another_shader_is_noticed_with_and_without_the_text(scene):
    from addon.material.group import material_group, script_node

    other = script_node(material_group("DIELECTRIC"))
    scene.script.bytecode = other.bytecode
    assert "not what its source gives" in the_finding(scene.scene)[2]
    bpy.data.texts.remove(scene.script.script)
    assert [finding.level for finding in findings(scene.scene)] == ["warning", "error"]


def test_a_comment_in_the_source_makes_no_other_program(scene):
    text = scene.script.script
    text.from_string("// A remark.\n\n" + text.as_string())
    assert findings(scene.scene) == []


def test_a_blender_without_osl_says_that_it_did_not_compare(scene, monkeypatch):
    from addon.farm import shaders
    from addon.material import script

    shaders._compiled.cache_clear()
    monkeypatch.setattr(script, "osl_compiler_available", lambda: False)
    level, _, message = the_finding(scene.scene)
    assert level == "note"
    assert "was not compared" in message


def test_a_group_of_another_version_is_a_note(scene):
    from addon.material.graph import KIND_KEY
    from addon.material.group import STAMP_KEY, VERSION_KEY

    scene.group[STAMP_KEY] = "0123456789abcdef"
    assert the_finding(scene.scene)[0] == "note"
    del scene.group[STAMP_KEY]
    assert the_finding(scene.scene)[0] == "note"
    assert "Update Materials" in findings(scene.scene)[0].remedy
    scene.group[VERSION_KEY] = "99.0.0"
    assert "newer version" in findings(scene.scene)[0].remedy
    scene.group[KIND_KEY] = "VELVET"
    level, _, message = the_finding(scene.scene)
    assert level == "warning"
    assert "'VELVET'" in message


def test_what_is_broken_in_an_old_group_is_mended_by_the_update(scene):
    from addon.material.group import STAMP_KEY
    from addon.material.update import update_materials

    scene.group[STAMP_KEY] = "0123456789abcdef"
    scene.script.bytecode = scene.script.bytecode_hash = ""
    found = findings(scene.scene)
    assert [finding.level for finding in found] == ["error", "note"]
    assert all("Update Materials" in finding.remedy for finding in found)
    update_materials()
    assert findings(scene.scene) == []


@pytest.mark.parametrize("lost", ["bytecode", "text"])
def test_adding_a_material_once_more_is_a_remedy(scene, lost):
    from addon.material.group import material_group

    if lost == "text":
        bpy.data.texts.remove(scene.script.script)
    else:
        scene.script.bytecode = ""
    (found,) = findings(scene.scene)
    assert "once more" in found.remedy
    material_group("DIFFUSE")
    assert findings(scene.scene) == []


def test_a_damaged_installation_is_told(scene, monkeypatch, tmp_path):
    from addon.core import shader_source

    monkeypatch.setattr(shader_source, "shader_directory", lambda: tmp_path)
    (found,) = findings(scene.scene)
    assert found.level == "warning"
    assert str(tmp_path) in found.remedy
    assert "Reinstall the extension" in found.remedy


def test_scene_settings(scene):
    scene.scene.cycles.device = "GPU"
    level, subject, message = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Scene 'Scene'")
    assert "OptiX" in message
    scene.scene.cycles.device = "CPU"
    scene.scene.cycles.shading_system = False
    assert the_finding(scene.scene)[::2] == (
        "error",
        "Open Shading Language is off; Cycles' own material shows.",
    )
    scene.scene.render.engine = "BLENDER_WORKBENCH"
    level, _, message = the_finding(scene.scene)
    assert level == "error"
    assert "not Cycles" in message


def test_an_unused_material_gives_notes_at_most(scene):
    scene.script.bytecode = ""
    scene.scene.cycles.shading_system = False
    scene.sphere.data.materials.clear()
    scene.material.use_fake_user = True
    level, _, message = the_finding(scene.scene)
    assert level == "note"
    assert "bytecode was taken out" in message


def test_groups_within_a_users_own_groups_count_once(scene):
    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    for _ in range(2):
        outer.nodes.new("ShaderNodeGroup").node_tree = scene.group
    material, tree, _ = surface_material("Nested")
    for _ in range(2):
        tree.nodes.new("ShaderNodeGroup").node_tree = outer
    tree.nodes.new("ShaderNodeGroup")
    scene.sphere.data.materials[0] = material
    bpy.data.materials.remove(scene.material)
    scene.script.bytecode = ""
    assert "bytecode was taken out" in the_finding(scene.scene)[2]
