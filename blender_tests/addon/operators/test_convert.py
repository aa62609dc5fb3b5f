# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that convert materials, and their panel."""

import re
from types import SimpleNamespace

import pytest

from blender_tests.addon.node_trees import (
    DIFFUSE,
    GLASS,
    METALLIC,
    PRINCIPLED,
    dump,
    material_with,
)

pytestmark = pytest.mark.usefixtures("compiled_once")

TYPES = {"Metal": METALLIC, "Glass": GLASS, "Matte": DIFFUSE, "Mixture": PRINCIPLED}


@pytest.fixture
def objects(registered):
    """Two selected objects, the second active, with the materials of TYPES; returns bpy."""
    bpy = registered
    for name, materials in (("First", ("Metal", "Glass")), ("Second", ("Matte", None, "Metal"))):
        mesh = bpy.data.meshes.new(name)
        for material in materials:
            mesh.materials.append(named(bpy, material) if material else None)
        obj = bpy.data.objects.new(name, mesh)
        bpy.context.scene.collection.objects.link(obj)
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    named(bpy, "Mixture")
    return bpy


def named(bpy, name):
    if name not in bpy.data.materials:
        material_with(TYPES[name])[0].name = name
    return next(m for m in bpy.data.materials if m.name in (name, TYPES[name]))


def converted(bpy):
    return sorted(
        material.name
        for material in bpy.data.materials
        for node in material.node_tree.nodes
        if node.bl_idname == "ShaderNodeGroup"
    )


def said(capfd):
    return capfd.readouterr().out


SCOPES = {
    "ACTIVE": ["Matte"],
    "SELECTED": ["Glass", "Matte", "Metal"],
    "ALL": ["Glass", "Matte", "Metal"],
}


@pytest.mark.parametrize("scope", SCOPES)
def test_each_scope_there_and_back(objects, scope):
    before = {m.name: dump(m.node_tree) for m in objects.data.materials}
    assert objects.ops.microbounce.to_microbounce(scope=scope) == {"FINISHED"}
    assert converted(objects) == SCOPES[scope]
    assert objects.ops.microbounce.to_native(scope=scope) == {"FINISHED"}
    assert {m.name: dump(m.node_tree) for m in objects.data.materials} == before


def test_the_summary_and_what_stays_are_reported(objects, capfd):
    objects.ops.microbounce.to_microbounce(scope="ALL")
    text = said(capfd)
    assert "3 of 4 materials converted (3 nodes); 1 cannot be converted" in text
    assert "Mixture: Principled BSDF stays. It is a matte surface under a glossy one" in text
    assert "Glass" not in text, "what goes without a loss is not worth a line"


def test_a_dry_run_reports_every_node_and_changes_nothing(objects, capfd):
    before = {m.name: dump(m.node_tree) for m in objects.data.materials}
    for name in ("to_microbounce", "to_native"):
        operator = getattr(objects.ops.microbounce, name)
        assert operator(scope="ALL", dry_run=True) == {"CANCELLED"}
    assert {m.name: dump(m.node_tree) for m in objects.data.materials} == before
    assert not objects.data.node_groups
    text = said(capfd)
    assert "3 of 4 materials would be converted" in text
    assert "Glass: Glass BSDF: Microbounce Dielectric" in text
    assert "0 of 4 materials would be converted (0 nodes)" in text


def test_the_active_material_is_the_one_that_the_editor_shows(registered):
    from addon.operators.convert import materials_in

    pinned, other = material_with(GLASS)[0], material_with(GLASS)[0]
    editor = SimpleNamespace(type="NODE_EDITOR", id=pinned)
    for context in (
        SimpleNamespace(space_data=editor, object=SimpleNamespace(active_material=other)),
        SimpleNamespace(space_data=None, material=pinned, object=None),
        SimpleNamespace(space_data=None, object=SimpleNamespace(active_material=pinned)),
    ):
        assert materials_in(context, "ACTIVE") == [pinned]


def test_without_materials(registered):
    poll = registered.ops.microbounce.to_microbounce.poll
    assert not poll()
    material_with(GLASS)
    assert poll()
    for scope, words in (("ACTIVE", "active object has no"), ("SELECTED", "selected objects have")):
        with pytest.raises(RuntimeError, match=words):
            registered.ops.microbounce.to_native(scope=scope)


def test_grease_pencil_materials_are_left_out(registered, capfd):
    pencil = registered.data.materials.new("Pencil")
    registered.data.materials.create_gpencil_data(pencil)
    assert not registered.ops.microbounce.to_microbounce.poll()
    material_with(GLASS)
    registered.ops.microbounce.to_microbounce(scope="ALL")
    assert "1 of 1 materials converted (1 node)" in said(capfd)


def test_undo_brings_the_native_nodes_back(objects):
    before = {m.name: dump(m.node_tree) for m in objects.data.materials}
    objects.ops.ed.undo_push(message="before")
    objects.ops.microbounce.to_microbounce("EXEC_DEFAULT", True, scope="ALL")
    assert len(converted(objects)) == 3
    objects.ops.ed.undo()
    assert {m.name: dump(m.node_tree) for m in objects.data.materials} == before
    objects.ops.ed.redo()
    assert len(converted(objects)) == 3
    objects.ops.microbounce.to_native(scope="ALL")
    assert {m.name: dump(m.node_tree) for m in objects.data.materials} == before


def test_a_dry_run_leaves_nothing_to_undo(objects):
    objects.ops.ed.undo_push(message="before")
    objects.data.materials["Glass"]["step"] = 1
    objects.ops.ed.undo_push(message="step")
    for name in ("to_microbounce", "to_native"):
        operator = getattr(objects.ops.microbounce, name)
        operator("EXEC_DEFAULT", True, scope="ALL", dry_run=True)
    objects.ops.ed.undo()
    assert "step" not in named(objects, "Glass"), "the step before the dry runs is the last"


def test_a_saved_file_keeps_the_way_back(objects, tmp_path):
    before = {m.name: dump(m.node_tree) for m in objects.data.materials}
    objects.ops.microbounce.to_microbounce(scope="ALL")
    path = str(tmp_path / "converted.blend")
    objects.ops.wm.save_as_mainfile(filepath=path)
    objects.ops.wm.open_mainfile(filepath=path)
    objects.ops.microbounce.to_native(scope="ALL")
    # Materials without users are not saved.
    assert {m.name: dump(m.node_tree) for m in objects.data.materials} == {
        name: tree for name, tree in before.items() if name != "Mixture"
    }


def test_a_damaged_installation_is_reported(objects, monkeypatch):
    from addon import convert
    from addon.core.shader_source import ShaderSourceError
    from addon.material.group import material_group

    def broken(kind):
        if kind == "DIFFUSE":
            raise ShaderSourceError("Reinstall the extension")
        return material_group(kind)

    monkeypatch.setattr(convert, "material_group", broken)
    with pytest.raises(RuntimeError, match="Reinstall the extension"):
        objects.ops.microbounce.to_microbounce(scope="ALL")
    assert converted(objects) == [], "also those whose group could be made"


class Layout:
    """Stands in for a layout: keeps the operators that are drawn, with their properties."""

    def __init__(self):
        self.drawn = []

    def split(self, factor=0.0, align=False):
        return self

    def operator(self, idname, icon="NONE"):
        return self.operator_menu_enum(idname, "")

    def operator_menu_enum(self, idname, name, text=""):
        properties = SimpleNamespace(dry_run=False)
        self.drawn.append((idname.removeprefix("microbounce."), name, properties))
        return properties


def test_the_panel_offers_both_directions_and_the_update(registered):
    from addon.ui import convert

    assert len(convert.CLASSES) == 2
    for panel in convert.CLASSES:
        layout = Layout()
        panel.draw(SimpleNamespace(layout=layout), None)
        assert [(name, scope, p.dry_run) for name, scope, p in layout.drawn] == [
            ("to_microbounce", "scope", False),
            ("to_microbounce", "scope", True),
            ("to_native", "scope", False),
            ("to_native", "scope", True),
            ("update_materials", "", False),
        ]
        assert hasattr(registered.types, panel.bl_parent_id)
        for name, scope, _ in layout.drawn:
            properties = getattr(registered.ops.microbounce, name).get_rna_type().properties
            assert not scope or re.fullmatch("ENUM", properties[scope].type)
