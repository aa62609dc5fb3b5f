# SPDX-License-Identifier: GPL-3.0-or-later
"""The check before rendering: what it finds in scenes, materials and node groups."""

import pytest

from blender_tests.addon.support import give_material, native_material, sphere

pytestmark = pytest.mark.usefixtures("compiled_once")


def script():
    """The script node of the file's one group."""
    import bpy

    from addon.material.group import script_node

    (group,) = bpy.data.node_groups
    return script_node(group)


def check(scene):
    import bpy

    from addon.scene.before_render import check_scene

    return check_scene(scene, bpy.context.preferences)


def the_finding(scene):
    (finding,) = check(scene)
    return finding


def test_without_our_materials_there_is_nothing_to_check(osl_scene):
    import bpy

    assert check(osl_scene) is None
    sphere().data.materials.append(native_material("CONDUCTOR"))
    sphere().data.materials.append(None)
    sphere().data.materials.append(bpy.data.materials.new("Plain"))
    assert check(osl_scene) is None
    assert check(bpy.data.scenes.new("Empty")) is None


def test_a_whole_material_has_no_findings(osl_scene, kind):
    give_material(kind)
    assert check(osl_scene) == ()


def test_only_what_renders_counts(osl_scene):
    import bpy

    give_material()
    osl_scene.cycles.shading_system = False
    assert the_finding(osl_scene).subject == f"Scene '{osl_scene.name}'"
    sphere().hide_render = True
    assert check(osl_scene) is None
    sphere().hide_render = False
    other = bpy.data.scenes.new("Other")
    assert check(other) is None
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type = "COLLECTION"
    instance.instance_collection = bpy.data.collections.new("Things")
    instance.instance_collection.objects.link(sphere())
    other.collection.objects.link(instance)
    assert check(other) is not None


def test_material_set_by_geometry_nodes_counts(osl_scene):
    import bpy

    from addon.material.node import new_material

    osl_scene.cycles.shading_system = False
    tree = bpy.data.node_groups.new("Outer", "GeometryNodeTree")
    inner = bpy.data.node_groups.new("Inner", "GeometryNodeTree")
    setter = inner.nodes.new("GeometryNodeSetMaterial")
    tree.nodes.new("GeometryNodeGroup").node_tree = inner
    modifier = sphere().modifiers.new("Nodes", "NODES")
    modifier.node_group = tree
    assert check(osl_scene) is None
    material = new_material("DIFFUSE", "Ours")
    setter.inputs["Material"].default_value = material
    assert "is off" in the_finding(osl_scene).message
    setter.inputs["Material"].default_value = None
    assert check(osl_scene) is None
    socket = tree.interface.new_socket("Skin", in_out="INPUT", socket_type="NodeSocketMaterial")
    if hasattr(modifier, "properties"):
        getattr(modifier.properties.inputs, socket.identifier).value = material
    else:
        modifier[socket.identifier] = material
    assert "is off" in the_finding(osl_scene).message


@pytest.mark.parametrize("nodes", [True, False])
def test_nodes_count_where_they_are_on(osl_scene, nodes):
    import bpy

    material = give_material()
    osl_scene.cycles.shading_system = False
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = nodes
        assert (check(osl_scene) is None) == (not nodes)
    else:
        assert len(check(osl_scene)) == 1


def engine_named(name):
    import bpy

    old = bpy.app.version < (5, 0, 0) and name == "EEVEE"
    return "BLENDER_EEVEE_NEXT" if old else f"BLENDER_{name}"


def osl_off(scene, monkeypatch):
    scene.cycles.shading_system = False
    return "Open Shading Language is off", "Switch it on"


def eevee(scene, monkeypatch):
    scene.render.engine = engine_named("EEVEE")
    return "not Cycles", "Choose Cycles"


def workbench(scene, monkeypatch):
    scene.render.engine = engine_named("WORKBENCH")
    return "not Cycles", "Choose Cycles"


def gpu(scene, monkeypatch):
    import bpy

    scene.cycles.device = "GPU"
    preferences = bpy.context.preferences.addons["cycles"].preferences
    preferences.compute_device_type = "CUDA"  # factory settings come before the next test
    monkeypatch.setattr(type(preferences), "has_active_device", lambda self: True)
    return "CUDA devices have no Open Shading Language", "with OptiX"


def no_osl(scene, monkeypatch):
    from addon.scene import status as scene_status

    monkeypatch.setattr(scene_status, "osl_compiler_available", lambda: False)
    return "built without Open Shading Language", "blender.org"


SCENES = [osl_off, eevee, workbench, gpu, no_osl]


@pytest.mark.parametrize("case", SCENES)
def test_a_scene_that_does_not_run_the_shaders_says_why(osl_scene, case, monkeypatch):
    give_material(Quality="Exact")  # the fallback misses no lights
    words, remedy = case(osl_scene, monkeypatch)
    finding = the_finding(osl_scene)
    assert finding.level == "warning"
    assert words in finding.message
    assert remedy in finding.remedy


def no_bytecode(group):
    script().bytecode = script().bytecode_hash = ""
    return "warning", "is not compiled", "which mends it"


def hash_alone(group):
    script().bytecode = ""
    return "error", "but not the hash", "which mends it"


def no_text(group):
    import bpy

    bpy.data.texts.remove(script().script)
    return "note", "text of its shader was deleted", "which mends it"


def no_script(group):
    group.nodes.remove(script())
    return "warning", "script node in its node group is gone", "Add a material"


def older(group):
    group["microbounce_stamp"] = "older"
    return "note", "nother version", "Update Materials"


def newer(group):
    group["microbounce_version"] = "99.0.0"
    older(group)
    return "note", "nother version", "Install that newer version"


GROUPS = [no_bytecode, hash_alone, no_text, no_script, older, newer]


@pytest.mark.parametrize("case", GROUPS)
def test_a_damaged_group_is_told_once_with_the_remedy(osl_scene, case):
    material = give_material()
    sphere().data.materials.append(material.copy())
    level, words, remedy = case(material.node_tree.nodes["Microbounce Conductor"].node_tree)
    finding = the_finding(osl_scene)
    assert finding.level == level
    assert words in finding.message
    assert remedy in finding.remedy
    assert finding.subject == "Material 'Ours' and 1 more"


@pytest.mark.parametrize("case", [no_bytecode, hash_alone, no_text])
def test_the_remedy_mends_the_group(osl_scene, case):
    import bpy

    give_material()
    case(bpy.data.node_groups[0])
    bpy.context.view_layer.objects.active = sphere()
    bpy.ops.microbounce.add_material(kind="CONDUCTOR")
    assert check(osl_scene) == ()


def test_lights_that_exact_misses(osl_scene):
    import bpy

    bpy.data.objects["Area"].data.cycles.use_multiple_importance_sampling = False
    material = give_material()
    assert check(osl_scene) == ()
    node = material.node_tree.nodes["Microbounce Conductor"]
    node.inputs["Quality"].default_value = 3
    assert "is black under 'Area' (Multiple Importance off)" in the_finding(osl_scene).message
    node.mute = True
    assert check(osl_scene) is None, "a muted node does nothing"


def test_a_damaged_installation_is_a_note(osl_scene, monkeypatch):
    from addon.core.shader_source import ShaderSourceError
    from addon.material import versions

    def missing(name):
        raise ShaderSourceError(f"The shader file {name}.osl is missing. Reinstall the extension")

    give_material()
    versions.forget_stamps()
    monkeypatch.setattr(versions, "inlined_source", missing)
    finding = the_finding(osl_scene)
    assert finding.level == "note"
    assert "Reinstall the extension" in finding.message
