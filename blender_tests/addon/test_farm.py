# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: every defect gives its own finding, a clean file none."""

import pytest

from addon.core.finding import Finding, by_level, counts, worst
from addon.core.kinds import KINDS
from addon.core.oso import same_program
from blender_tests.addon.support import small_scene, surface_material


class OurScene:
    """A clean scene of one sphere with one material, and what the tests damage in it."""

    def __init__(self, bpy, kind):
        from addon.nodes.group import new_material, script_node

        self.bpy = bpy
        self.scene, self.sphere = small_scene(osl=True)
        self.material = new_material(kind, "Ours")
        self.sphere.data.materials.append(self.material)
        self.group = bpy.data.node_groups[KINDS[kind].name]
        self.script = script_node(self.group)


@pytest.fixture
def scene(registered):
    """A clean scene with our metal."""
    return OurScene(registered, "CONDUCTOR")


def findings(scene):
    from addon.nodes.farm.check import farm_findings

    return farm_findings(scene)


def the_finding(scene):
    """The one finding, as level, subject and message; every finding of worth has a remedy."""
    (found,) = findings(scene)
    assert found.remedy
    return found.level, found.subject, found.message


def test_a_clean_file_has_no_finding(registered, kind):
    assert findings(OurScene(registered, kind).scene) == []


def test_files_without_our_materials_have_none(registered):
    assert findings(registered.context.scene) == []
    scene, sphere = small_scene(osl=False)
    sphere.data.materials.append(surface_material("Plain")[0])
    sphere.data.materials.append(None)
    assert findings(scene) == []


@pytest.mark.parametrize(
    ("lost", "level", "words"),
    [
        ("bytecode", "error", "has no bytecode"),
        ("bytecode_hash", "error", "has no bytecode"),
        ("text", "warning", "source is gone"),
        ("script", "error", "script node is gone"),
    ],
)
def test_what_was_taken_out_of_a_group_is_missed(scene, lost, level, words):
    if lost == "text":
        scene.bpy.data.texts.remove(scene.script.script)
    elif lost == "script":
        scene.group.nodes.remove(scene.script)
    else:
        setattr(scene.script, lost, "")
    found = the_finding(scene.scene)
    assert found[:2] == (level, "Node group 'Microbounce Conductor'")
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
    scene.script.script = scene.bpy.data.texts.load(str(path))
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
    scene = OurScene(registered, kind)
    text = scene.script.script
    source = text.as_string()
    assert old in source
    text.from_string(source.replace(old, new))
    level, _, message = the_finding(scene.scene)
    assert level == "error"
    assert words in message


def test_the_bytecode_of_another_shader_is_noticed_with_and_without_the_text(scene):
    from addon.nodes.group import material_group, script_node

    other = script_node(material_group("DIFFUSE"))
    scene.script.bytecode = other.bytecode
    assert "not what its source gives" in the_finding(scene.scene)[2]
    scene.bpy.data.texts.remove(scene.script.script)
    assert [finding.level for finding in findings(scene.scene)] == ["warning", "error"]


def test_a_comment_in_the_source_makes_no_other_program(scene):
    text = scene.script.script
    text.from_string("// A remark.\n\n" + text.as_string())
    assert findings(scene.scene) == []


def test_a_blender_without_osl_says_that_it_did_not_compare(scene, monkeypatch):
    from addon.nodes import script
    from addon.nodes.farm import shaders

    shaders._compiled.cache_clear()
    monkeypatch.setattr(script, "osl_compiler_available", lambda: False)
    level, _, message = the_finding(scene.scene)
    assert level == "note"
    assert "was not compared" in message


def test_a_group_of_another_version_is_a_note(scene):
    from addon.nodes.group import KIND_KEY, STAMP_KEY

    scene.group[STAMP_KEY] = "0123456789abcdef"
    assert the_finding(scene.scene)[0] == "note"
    del scene.group[STAMP_KEY]
    assert the_finding(scene.scene)[0] == "note"
    scene.group[KIND_KEY] = "VELVET"
    level, _, message = the_finding(scene.scene)
    assert level == "warning"
    assert "'VELVET'" in message


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
    assert "has no bytecode" in message


def test_groups_within_a_users_own_groups_count_once(scene):
    bpy = scene.bpy
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
    assert "has no bytecode" in the_finding(scene.scene)[2]


def add_image(scene, image):
    node = scene.material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    return node


def test_images_that_are_not_in_the_file(scene, tmp_path):
    data = scene.bpy.data
    image = data.images.new("Wear", 2, 2)
    image.filepath_raw = str(tmp_path / "wear.png")
    image.file_format = "PNG"
    image.save()
    data.images.remove(image)
    image = data.images.load(str(tmp_path / "wear.png"))
    node = add_image(scene, image)
    level, subject, message = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Image 'wear.png' of material 'Ours'")
    assert str(tmp_path / "wear.png") in message
    assert "outside this one" in message
    (tmp_path / "wear.png").unlink()
    assert "is missing" in the_finding(scene.scene)[2]
    node.image = data.images.new("Generated", 2, 2)
    assert findings(scene.scene) == []
    node.image.pixels[0] = 0.5
    assert "not saved" in the_finding(scene.scene)[2]
    node.image.pack()
    assert findings(scene.scene) == []


def drive(socket, expression):
    driver = socket.driver_add("default_value").driver
    driver.type = "SCRIPTED"
    driver.expression = expression


def test_drivers_that_are_python(scene):
    node = scene.material.node_tree.nodes["Microbounce Conductor"]
    drive(node.inputs["Roughness"], "sin(frame) * 0.5")
    assert findings(scene.scene) == [], "a simple expression needs no Python"
    drive(node.inputs["Anisotropy"], "len(bpy.data.objects)")
    level, subject, message = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Driver of material 'Ours'")
    assert "len(bpy.data.objects)" in message


def test_texts_that_need_the_extension(scene):
    text = scene.bpy.data.texts.new("start.py")
    text.from_string("import bl_ext.user_default.microbounce\n")
    assert findings(scene.scene) == []
    text.use_module = True
    level, subject, _ = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Text 'start.py'")


def linked(scene, tmp_path, relative, what="materials"):
    """Link our material, or its group, from a library into a new file beside it and open it."""
    bpy = scene.bpy
    library, user = tmp_path / "library.blend", tmp_path / "user.blend"
    bpy.data.libraries.write(str(library), {scene.material})
    _, sphere = small_scene(osl=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(user))
    with bpy.data.libraries.load(str(library), link=True, relative=relative) as (there, wanted):
        setattr(wanted, what, getattr(there, what))
    if what == "materials":
        sphere.data.materials.append(bpy.data.materials["Ours"])
    else:
        material, tree, _ = surface_material("Local")
        tree.nodes.new("ShaderNodeGroup").node_tree = bpy.data.node_groups[0]
        sphere.data.materials.append(material)
    bpy.ops.wm.save_as_mainfile(filepath=str(user))
    bpy.ops.wm.open_mainfile(filepath=str(user))
    return bpy.context.scene, library


@pytest.mark.parametrize("what", ["materials", "node_groups"])
def test_libraries(scene, tmp_path, what):
    user, library = linked(scene, tmp_path, relative=True, what=what)
    level, subject, message = the_finding(user)
    assert (level, subject) == ("note", "Library '//library.blend'")
    assert "'Microbounce Conductor'" in message
    library.unlink()
    scene.bpy.ops.wm.open_mainfile(filepath=scene.bpy.data.filepath)
    found = findings(scene.bpy.context.scene)
    assert [(f.level, f.subject) for f in found] == [("error", "Library '//library.blend'")]
    assert "is missing" in found[0].message


def test_a_library_by_an_absolute_path(scene, tmp_path):
    user, library = linked(scene, tmp_path, relative=False)
    level, subject, message = the_finding(user)
    assert (level, subject) == ("warning", f"Library '{library}'")
    assert "absolute path" in message


def test_levels_of_findings():
    with pytest.raises(ValueError, match="The level is 'bad': use one of error, warning, note"):
        Finding("bad", "Scene", "It is bad.")
    note, error = Finding("note", "A", "Small."), Finding("error", "B", "Big.", "Mend it.")
    assert (worst([]), worst([note]), worst([note, error])) == ("", "note", "error")
    assert by_level([note, error]) == (error, note)
    assert counts([note, error, note]) == "1 error, 2 notes"
    assert error.as_text() == "Error: B: Big. Mend it."
    assert error.as_dict() == {
        "level": "error",
        "subject": "B",
        "message": "Big.",
        "remedy": "Mend it.",
    }


A_PROGRAM = """OpenShadingLanguage 1.00
# Compiled by one
shader small
param float Width 0.5 %meta{string,label,"Width"} %read{0,1}
local float ___1_x %read{1,2}
const float $const1 2
temp float $tmp1
code ___main___
	mul $tmp1 Width $const1 %line{3} %argrw{"wrr"}
	assign ___1_x $tmp1
	end
"""


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("___1_x", "___7_x", True),
        ("$tmp1", "$tmp9", True),
        ("# Compiled by one\n", "", True),
        ("%line{3}", "%line{8}", True),
        ("const1 2", "const1 3", False),
        ("mul", "add", False),
        ("Width 0.5", "Width 0.6", False),
        ("mul $tmp1 Width $const1", "mul $tmp1 $const1 Width", False),
        ("temp float", "temp color", False),
        ("\tend\n", "", False),
    ],
)
def test_same_program(old, new, same):
    assert old in A_PROGRAM
    assert same_program(A_PROGRAM, A_PROGRAM.replace(old, new)) is same
