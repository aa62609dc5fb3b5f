# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators: what they change, when they refuse, and what they say."""

from types import SimpleNamespace

import pytest

from addon.core.kinds import KINDS
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


def new_object(bpy, data, name="Thing"):
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    return obj


def is_microbounce(material, kind):
    return any(
        node.bl_idname == "ShaderNodeGroup" and node.node_tree.get("microbounce_kind") == kind
        for node in material.node_tree.nodes
    )


def linked_objects(bpy, tmp_path, with_slot=False):
    """Save a mesh object to a library; return a file with it linked, active and current."""
    path = tmp_path / "library.blend"
    mesh = bpy.data.meshes.new("Library Mesh")
    obj = bpy.data.objects.new("Library Thing", mesh)
    if with_slot:
        mesh.materials.append(bpy.data.materials.new("Library Material"))
    bpy.data.libraries.write(str(path), {obj})
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = ["Library Thing"]
    linked = bpy.data.objects["Library Thing"]
    bpy.context.scene.collection.objects.link(linked)
    bpy.context.view_layer.objects.active = linked
    return linked


@pytest.mark.parametrize("with_slot", [False, True])
def test_overridden_data_keep_no_material(registered, tmp_path, with_slot):
    obj = linked_objects(registered, tmp_path, with_slot)
    obj = obj.override_create(remap_local_usages=True)
    obj.data.override_create(remap_local_usages=True)
    registered.context.view_layer.objects.active = obj
    if not with_slot:
        with pytest.raises(RuntimeError, match="have no material slot: make the data local"):
            registered.ops.microbounce.add_material(kind="DIFFUSE")
        return
    registered.ops.microbounce.add_material(kind="DIFFUSE")
    path = str(tmp_path / "user.blend")
    registered.ops.wm.save_as_mainfile(filepath=path)
    registered.ops.wm.open_mainfile(filepath=path)
    (obj,) = [found for found in registered.data.objects if not found.library]
    assert is_microbounce(obj.material_slots[0].material, "DIFFUSE")


def test_osl_of_a_linked_scene_is_switched_on_in_its_own_file(registered, tmp_path):
    data, path = registered.data, tmp_path / "library.blend"
    registered.context.scene.render.engine = "CYCLES"
    registered.context.scene.name = "Shot"
    data.libraries.write(str(path), {registered.context.scene})
    with data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.scenes = ["Shot"]
    (linked,) = [scene for scene in data.scenes if scene.library]
    with (
        registered.context.temp_override(scene=linked),
        pytest.raises(RuntimeError, match="'Shot' is linked from a library: switch it on there"),
    ):
        registered.ops.microbounce.enable_osl()
    assert not linked.cycles.shading_system


def test_object_without_slots_gets_one(registered, kind):
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert [is_microbounce(slot.material, kind) for slot in obj.material_slots] == [True]


def test_only_the_active_slot_is_replaced(registered, kind):
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    others = [registered.data.materials.new(name) for name in "abc"]
    for material in others:
        obj.data.materials.append(material)
    obj.active_material_index = 1
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    first, second, third = (slot.material for slot in obj.material_slots)
    assert (first, third) == (others[0], others[2])
    assert is_microbounce(second, kind)
    assert others[1].name in registered.data.materials, "the old material stays in the file"


def test_empty_slot_and_object_slot_are_filled(registered, kind):
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    obj.data.materials.append(None)
    obj.material_slots[0].link = "OBJECT"
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert is_microbounce(obj.material_slots[0].material, kind)
    assert obj.data.materials[0] is None, "the slot belongs to the object"


@pytest.mark.parametrize("data_type", ["CURVE", "SURFACE", "FONT", "META"])
def test_other_surfaces_get_it_too(registered, kind, data_type):
    make = registered.data.metaballs.new if data_type == "META" else registered.data.curves.new
    obj = new_object(registered, make("Data") if data_type == "META" else make("Data", data_type))
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert is_microbounce(obj.active_material, kind)


def test_a_second_material_shares_the_group(registered, kind):
    for name in "ab":
        new_object(registered, registered.data.meshes.new(name), name)
        registered.ops.microbounce.add_material(kind=kind)
    assert len(registered.data.materials) == 2
    assert len(registered.data.node_groups) == 1


def test_each_kind_has_a_group_of_its_own(registered):
    for kind in KINDS:
        new_object(registered, registered.data.meshes.new(kind), kind)
        registered.ops.microbounce.add_material(kind=kind)
    names = sorted(kind.name for kind in KINDS.values())
    assert [group.name for group in registered.data.node_groups] == names
    assert [material.name for material in registered.data.materials] == names


def test_a_kind_that_is_not_made_is_refused(registered):
    new_object(registered, registered.data.meshes.new("Mesh"))
    with pytest.raises(TypeError, match="not found in"):
        registered.ops.microbounce.add_material(kind="GLASS")


def test_the_material_can_be_undone(registered, kind):
    bpy = registered
    bpy.context.preferences.edit.use_global_undo = True
    new_object(bpy, bpy.data.meshes.new("Mesh"))
    bpy.ops.ed.undo_push(message="Before")
    assert bpy.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    bpy.ops.ed.undo_push(message="After")
    bpy.ops.ed.undo()
    assert not bpy.data.objects["Thing"].material_slots
    assert not bpy.data.materials
    bpy.ops.ed.redo()
    assert is_microbounce(bpy.data.objects["Thing"].material_slots[0].material, kind)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda bpy: None, "There is no active object"),
        (lambda bpy: new_object(bpy, None), "is of type empty and has no surface"),
        (lambda bpy: new_object(bpy, bpy.data.cameras.new("C")), "type camera"),
        (lambda bpy: new_object(bpy, bpy.data.lights.new("L", "SUN")), "type light"),
        (lambda bpy: new_object(bpy, bpy.data.volumes.new("V")), "type volume"),
    ],
    ids=["none", "empty", "camera", "light", "volume"],
)
def test_unsuitable_objects_are_refused(registered, kind, make, words):
    make(registered)
    assert not registered.ops.microbounce.add_material.poll()
    with pytest.raises(RuntimeError, match=words):
        registered.ops.microbounce.add_material(kind=kind)
    assert not registered.data.materials


def test_linked_object_is_refused(registered, kind, tmp_path):
    linked_objects(registered, tmp_path)
    with pytest.raises(RuntimeError, match="is linked from a library: make it local"):
        registered.ops.microbounce.add_material(kind=kind)


def test_local_object_with_linked_data(registered, kind, tmp_path):
    linked = linked_objects(registered, tmp_path)
    new_object(registered, linked.data)
    with pytest.raises(RuntimeError, match="have no material slot: make the data local"):
        registered.ops.microbounce.add_material(kind=kind)


def test_local_object_with_linked_data_and_a_slot_overrides_it(registered, kind, tmp_path):
    linked = linked_objects(registered, tmp_path, with_slot=True)
    obj = new_object(registered, linked.data)
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert obj.material_slots[0].link == "OBJECT"
    assert is_microbounce(obj.material_slots[0].material, kind)
    assert obj.data.materials[0].name == "Library Material"


def test_library_override_gets_it(registered, kind, tmp_path):
    linked = linked_objects(registered, tmp_path, with_slot=True)
    obj = linked.override_create(remap_local_usages=True)
    registered.context.view_layer.objects.active = obj
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert is_microbounce(obj.material_slots[0].material, kind)


def test_failure_is_an_error_and_leaves_the_object_alone(registered, kind, monkeypatch):
    from addon.core.shader_source import ShaderSourceError
    from addon.material import group

    def missing(name):
        raise ShaderSourceError(f"The shader file {name}.osl is missing. Reinstall the extension")

    monkeypatch.setattr(group, "inlined_source", missing)
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    with pytest.raises(RuntimeError, match="Reinstall the extension"):
        registered.ops.microbounce.add_material(kind=kind)
    assert not obj.material_slots
    assert not registered.data.materials


def test_osl_off_warns_and_still_works(registered, kind, capfd):
    scene = registered.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.shading_system = False
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    assert registered.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert is_microbounce(obj.active_material, kind)
    assert not scene.cycles.shading_system, "switching it on is for the user"
    assert "Open Shading Language is off" in capfd.readouterr().out


def test_osl_on_says_nothing(registered, kind, capfd):
    registered.context.scene.render.engine = "CYCLES"
    registered.context.scene.cycles.shading_system = True
    new_object(registered, registered.data.meshes.new("Mesh"))
    registered.ops.microbounce.add_material(kind=kind)
    assert "Warning" not in capfd.readouterr().out


def test_enable_osl(registered):
    scene = registered.context.scene
    enable = registered.ops.microbounce.enable_osl
    with pytest.raises(RuntimeError, match="Choose Cycles"):
        enable()
    scene.render.engine = "CYCLES"
    assert enable() == {"FINISHED"}
    assert scene.cycles.shading_system
    with pytest.raises(RuntimeError, match="Open Shading Language is on"):
        enable()


def test_device_without_osl_is_reported(registered, monkeypatch, capfd):
    from addon.operators.osl import osl_status

    context = registered.context
    scene = context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "GPU"
    preferences = context.preferences.addons["cycles"].preferences
    preferences.compute_device_type = "CUDA"
    monkeypatch.setattr(type(preferences), "has_active_device", lambda self: False)
    scene.cycles.shading_system = True
    assert osl_status(context).ok, "without a GPU Cycles takes the CPU"
    monkeypatch.setattr(type(preferences), "has_active_device", lambda self: True)
    assert "CUDA devices have no Open Shading Language" in osl_status(context).message
    scene.cycles.shading_system = False
    registered.ops.microbounce.enable_osl()
    assert "Render on the CPU or with OptiX" in capfd.readouterr().out
    preferences.compute_device_type = "OPTIX"
    assert osl_status(context).ok
    preferences.compute_device_type = "NONE"


@pytest.fixture
def editor(registered):
    """A Shader editor as the context; yields bpy and its space."""
    window = registered.context.window_manager.windows[0]
    area = window.screen.areas[0]
    before = area.ui_type
    area.ui_type = "ShaderNodeTree"
    space = area.spaces.active
    space.pin = True
    region = next(region for region in area.regions if region.type == "WINDOW")
    with registered.context.temp_override(window=window, area=area, region=region):
        yield registered, space
    space.node_tree = None
    space.pin = False
    area.ui_type = before


def test_node_is_added_at_the_cursor_and_selected(editor, kind):
    bpy, space = editor
    _, tree, output = surface_material("Metal")
    space.node_tree = tree
    space.cursor_location = (123, 45)
    assert bpy.ops.microbounce.add_node(kind=kind) == {"FINISHED"}
    (node,) = [node for node in tree.nodes if node != output]
    assert tuple(node.location) == pytest.approx((123, 45))
    assert tree.nodes.active == node
    assert [n.select for n in (node, output)] == [True, False]
    assert node.node_tree.name == KINDS[kind].name


def test_node_is_refused_outside_a_material(editor, kind):
    bpy, space = editor
    add = bpy.ops.microbounce.add_node
    space.node_tree = None
    with pytest.raises(RuntimeError, match="There is no material here: press New"):
        add(kind=kind)
    space.shader_type = "WORLD"
    with pytest.raises(RuntimeError, match="These materials are for objects"):
        add(kind=kind)
    space.shader_type = "OBJECT"


def test_node_is_refused_outside_the_shader_editor(registered, kind):
    with pytest.raises(RuntimeError, match="This works in the Shader editor"):
        registered.ops.microbounce.add_node(kind=kind)


def test_group_cannot_hold_itself(editor, kind):
    from addon.material.group import material_group

    bpy, space = editor
    group = material_group(kind)
    space.node_tree = group
    with pytest.raises(RuntimeError, match="cannot hold itself"):
        bpy.ops.microbounce.add_node(kind=kind)


def test_operators_are_undoable_and_described(registered):
    for name in ("add_material", "add_node", "enable_osl"):
        operator = getattr(registered.ops.microbounce, name)
        rna = operator.get_rna_type()
        assert operator.bl_options >= {"REGISTER", "UNDO"}
        assert rna.description
        assert not rna.description.endswith(".")
        assert rna.name == rna.name.title()


@pytest.mark.parametrize("name", ["MICROBOUNCE_OT_add_material", "MICROBOUNCE_OT_add_node"])
def test_tooltips_name_the_kind(registered, name, kind):
    cls = getattr(registered.types, name)
    text = cls.description(registered.context, SimpleNamespace(kind=kind))
    made = KINDS[kind]
    assert made.name in text or made.surface.lower() in text
    assert not text.endswith(".")
