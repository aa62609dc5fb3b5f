# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels say and offer, drawn into a record instead of a window."""

from types import SimpleNamespace

import pytest

from addon.core.kinds import KINDS
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


class Record:
    """Stands in for a layout: keeps the texts and operators, and checks that they can be drawn."""

    def __init__(self):
        import bpy

        self.texts, self.operators, self.buttons, self.menus = [], [], [], []
        self.titles = []  # of the menus
        self.label_icons = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"]

    def box(self):
        return self

    def column(self, align=False):
        return self

    def split(self, factor):
        return self

    def label(self, text="", icon="NONE"):
        assert icon in self.label_icons.enum_items
        self.texts.append(text)

    def operator(self, idname, text="", icon="NONE"):
        import bpy

        assert icon in self.label_icons.enum_items
        module, name = idname.split(".")
        assert name in dir(getattr(bpy.ops, module))
        self.operators.append(name)
        self.buttons.append(SimpleNamespace(kind="", text=text))
        return self.buttons[-1]

    def menu(self, name, text="", icon="NONE"):
        import bpy

        assert icon in self.label_icons.enum_items
        self.titles.append(text)
        self.menus.append(getattr(bpy.types, name))

    def separator(self):
        pass

    @property
    def text(self):
        return " ".join(self.texts)


def draw(bpy, panel, **members):
    """Draw `panel` in a context of the current scene with `members`; None if it is not shown."""
    from addon.ui import panels

    cls = getattr(panels, panel)
    scale = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    addons = bpy.context.preferences.addons
    context = SimpleNamespace(
        **{
            "scene": bpy.context.scene,
            "view_layer": bpy.context.view_layer,
            "object": bpy.context.object,
            "space_data": SimpleNamespace(type="PROPERTIES"),
            "region": SimpleNamespace(width=400),
            "preferences": SimpleNamespace(system=scale.system, addons=addons),
        }
        | members
    )
    if not cls.poll(context):
        return None
    record = Record()
    cls.draw(SimpleNamespace(layout=record), context)
    return record


def node_editor(shown=None, tree_type="ShaderNodeTree"):
    tree = shown.node_tree if shown else None
    return SimpleNamespace(type="NODE_EDITOR", tree_type=tree_type, node_tree=tree, id=shown)


@pytest.fixture
def sun_lit(registered):
    """Cycles with OSL, an object without material, and a sun of angle 0; returns bpy."""
    bpy = registered
    bpy.context.scene.render.engine = "CYCLES"
    bpy.context.scene.cycles.shading_system = True
    light = bpy.data.lights.new("Sun", "SUN")
    light.angle = 0.0
    sun = bpy.data.objects.new("Sun", light)
    thing = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    for obj in (sun, thing):
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = thing
    return bpy


def exact_material(kind):
    from addon.material.node import new_material

    return new_material(kind, "Exact", Quality="Exact")


def test_material_panel_names_lights_that_exact_misses(sun_lit, kind):
    material = exact_material(kind)
    sun_lit.context.object.data.materials.append(material)
    record = draw(sun_lit, "MICROBOUNCE_PT_material", material=material)
    assert "Open Shading Language is on" in record.text
    assert "is black under 'Sun' (angle 0). Remedy: set Quality to Walk" in record.text
    assert max(len(text) for text in record.texts) <= 400 / 8, "lines are cut by the panel's edge"
    sun_lit.data.lights["Sun"].angle = 0.01
    assert "Exact" not in draw(sun_lit, "MICROBOUNCE_PT_material", material=material).text


def test_shader_editor_looks_at_the_material_it_shows(sun_lit, kind):
    panel = "MICROBOUNCE_PT_shader_editor"
    other, _, _ = surface_material("Other")
    sun_lit.context.object.data.materials.append(other)
    pinned = draw(sun_lit, panel, space_data=node_editor(exact_material(kind)))
    assert "'Sun' (angle 0)" in pinned.text
    assert "Sun" not in draw(sun_lit, panel, space_data=node_editor(other)).text
    for shown in (None, sun_lit.data.worlds.new("World")):
        record = draw(sun_lit, panel, space_data=node_editor(shown))
        assert "Sun" not in record.text
        assert record.operators == ["add_node"] * len(KINDS)
    assert draw(sun_lit, panel, space_data=node_editor(tree_type="GeometryNodeTree")) is None


def test_pinned_material_without_an_active_object(sun_lit, kind):
    material = exact_material(kind)
    sun_lit.context.view_layer.objects.active = None
    record = draw(sun_lit, "MICROBOUNCE_PT_material", object=None, material=material)
    assert "'Sun' (angle 0)" in record.text
    assert draw(sun_lit, "MICROBOUNCE_PT_material", object=None, material=None) is None


def test_material_without_nodes(sun_lit):
    plain = sun_lit.data.materials.new("Plain")
    sun_lit.context.object.data.materials.append(plain)
    record = draw(sun_lit, "MICROBOUNCE_PT_material", material=plain)
    assert record.texts == ["Open Shading Language is on"]


@pytest.mark.parametrize(
    ("engine", "osl", "words", "offers"),
    [
        ("CYCLES", False, "Open Shading Language is off", ["enable_osl"]),
        ("BLENDER_WORKBENCH", True, "The render engine is not Cycles", []),
        ("BLENDER_EEVEE_NEXT", False, "The render engine is not Cycles", []),
    ],
)
def test_where_the_shader_does_not_run_the_panel_says_why(sun_lit, engine, osl, words, offers):
    scene = sun_lit.context.scene
    if engine.startswith("BLENDER_EEVEE") and sun_lit.app.version >= (5, 0, 0):
        engine = "BLENDER_EEVEE"
    scene.cycles.shading_system = osl
    scene.render.engine = engine
    record = draw(sun_lit, "MICROBOUNCE_PT_material", material=exact_material("CONDUCTOR"))
    assert words in record.text
    assert "Sun" not in record.text, "the fallback finds every light"
    assert record.operators == [*offers, *["add_material"] * len(KINDS)]


def test_without_the_cycles_add_on(registered):
    scene = SimpleNamespace(render=SimpleNamespace(engine="BLENDER_WORKBENCH"))
    thing = SimpleNamespace(active_material=None)
    record = draw(registered, "MICROBOUNCE_PT_material", object=thing, scene=scene)
    assert "The render engine is not Cycles" in record.text


def test_panels_and_menu_offer_each_kind(sun_lit):
    from addon.ui import menus

    for panel in ("MICROBOUNCE_PT_material", "MICROBOUNCE_PT_shader_editor"):
        record = draw(sun_lit, panel, space_data=node_editor())
        assert [button.kind for button in record.buttons] == list(KINDS)
    record = Record()
    space = SimpleNamespace(shader_type="OBJECT")
    menus.draw_add_menu(SimpleNamespace(layout=record), SimpleNamespace(space_data=space))
    (menu,) = record.menus
    assert menu.bl_label == "Microbounce"
    menus.MICROBOUNCE_MT_add.draw(SimpleNamespace(layout=record), None)
    assert record.operators == ["add_node"] * len(KINDS)
    assert [button.kind for button in record.buttons] == list(KINDS)


def test_the_menu_is_for_materials_of_objects(sun_lit):
    from addon.ui import menus

    record = Record()
    space = SimpleNamespace(shader_type="WORLD")
    menus.draw_add_menu(SimpleNamespace(layout=record), SimpleNamespace(space_data=space))
    assert not record.menus
