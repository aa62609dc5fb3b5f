# SPDX-License-Identifier: GPL-3.0-or-later
"""What the preset panels and menus show and offer, drawn into a record instead of a window."""

from types import SimpleNamespace

import pytest

from addon.core.kinds import KINDS
from addon.core.presets import catalogue as presets
from blender_tests.addon.operators.test_operators import new_object
from blender_tests.addon.presets.test_apply import OTHER, first_preset, our_material
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


class Record:
    """Stands in for a layout: keeps texts, menus, buttons and icons, and checks that they exist."""

    def __init__(self):
        self.texts, self.menus, self.buttons, self.icons, self.panels = [], [], [], [], []

    def row(self, align=False):
        return self

    column = box = row

    def panel_prop(self, data, name):
        self.panels.append((name, getattr(data, name)))
        return self, self

    def grid_flow(self, **options):
        return self

    def separator(self):
        pass

    def label(self, text="", icon="NONE"):
        self.texts.append(text)

    def menu(self, name):
        import bpy

        self.menus.append(getattr(bpy.types, name))

    def prop(self, data, name, text=""):
        assert name in data.bl_rna.properties

    def template_icon(self, icon_value, scale):
        self.icons.append(icon_value)

    def operator(self, idname, text="", icon="NONE"):
        import bpy

        module, name = idname.split(".")
        known = getattr(getattr(bpy.ops, module), name).get_rna_type().properties.keys()
        button = Button(name, text, known)
        self.buttons.append(button)
        return button

    def named(self, name):
        return [button for button in self.buttons if button.name == name]


class Button:
    """Stands in for the properties of an operator; takes those alone that the operator has."""

    def __init__(self, name, text, known):
        object.__setattr__(self, "known", known)
        self.__dict__.update(name=name, text=text)

    def __setattr__(self, key, value):
        assert key in self.known, key
        self.__dict__[key] = value


def draw(bpy, cls, material=None):
    """Draw a panel or menu in the material properties of `material`."""
    record = Record()
    context = SimpleNamespace(
        space_data=SimpleNamespace(type="PROPERTIES"),
        material=material,
        object=bpy.context.object,
        window_manager=bpy.context.window_manager,
        preferences=bpy.context.preferences,
        region=SimpleNamespace(width=2000),
    )
    getattr(bpy.types, cls).draw(SimpleNamespace(layout=record), context)
    return record


PANEL = "MICROBOUNCE_PT_material_presets"


def shown(record):
    return [button.identifier for button in record.named("apply_preset")]


def test_pictures_are_those_of_the_materials_kind_or_as_chosen(registered, kind):
    wm = registered.context.window_manager
    material, _ = our_material(kind)
    own = [preset.identifier for preset in presets.presets(kind)]
    record = draw(registered, PANEL, material)
    assert shown(record) == own
    assert len(record.icons) == len(own)
    assert [is_open for _, is_open in record.panels] == [False], "they take much room"
    assert [button.text for button in record.named("apply_preset")] == [
        preset.name for preset in presets.presets(kind)
    ]
    wm.microbounce_presets_shown = "ALL"
    everything = [preset.identifier for preset in presets.presets()]
    assert shown(draw(registered, PANEL, material)) == everything
    wm.microbounce_presets_shown = OTHER[kind]
    others = [preset.identifier for preset in presets.presets(OTHER[kind])]
    assert shown(draw(registered, PANEL, material)) == others
    wm.microbounce_presets_shown = "MATERIAL"
    foreign, _, _ = surface_material("Foreign")
    for material in (foreign, None):
        assert shown(draw(registered, PANEL, material)) == everything


def test_the_source_of_the_preset_last_applied_is_linked(registered, kind):
    from addon.material.node import material_node
    from addon.presets.apply import apply_preset

    material, _ = our_material(kind)
    assert not draw(registered, PANEL, material).named("url_open")
    preset = first_preset(kind)
    apply_preset(material, preset)
    record = draw(registered, PANEL, material)
    assert {preset.name, preset.source.title} <= set(record.texts)
    assert [button.url for button in record.named("url_open")] == [preset.source.url]
    for unknown in ("user/conductor/gold", "conductor/of another version", 7):
        material_node(material)["microbounce_preset"] = unknown
        assert not draw(registered, PANEL, material).named("url_open")


def test_search_finishes_and_own_presets_are_offered(registered, kind):
    material, _ = our_material(kind)
    record = draw(registered, PANEL, material)
    assert record.named("search_preset")
    assert [menu.bl_label for menu in record.menus] == ["Finish", "My Presets"]
    finishes = draw(registered, "MICROBOUNCE_MT_finishes", material).named("apply_finish")
    assert [entry.identifier for entry in finishes] == [
        finish.identifier for finish in presets.finishes(kind)
    ]
    every = draw(registered, "MICROBOUNCE_MT_finishes").named("apply_finish")
    assert len(every) == len(presets.finishes())


def test_own_presets_are_listed_by_kind_with_a_way_to_remove_them(
    registered, tmp_path, monkeypatch
):
    def preset_paths(subdir):
        folder = tmp_path / subdir
        folder.mkdir(parents=True, exist_ok=True)
        return [str(folder)]

    monkeypatch.setattr(registered.utils, "preset_paths", preset_paths)
    names = [button.name for button in draw(registered, "MICROBOUNCE_MT_user_presets").buttons]
    assert names == ["save_preset"]
    for kind in ("diffuse", "conductor"):
        path = tmp_path / "microbounce" / kind / f"my_{kind}.toml"
        path.write_text("damaged, and listed all the same")
        path.with_suffix(".py").write_text("raise SystemExit")
    record = draw(registered, "MICROBOUNCE_MT_user_presets")
    assert [button.text for button in record.named("apply_user_preset")] == [
        "my conductor",
        "my diffuse",
    ]
    assert len(record.named("remove_user_preset")) == 2
    assert record.texts == ["Conductor", "Diffuse"]


def test_damaged_presets_are_named(registered, monkeypatch, tmp_path):
    monkeypatch.setattr(presets, "FOLDER", tmp_path)
    presets.clear_cache()
    try:
        record = draw(registered, PANEL)
    finally:
        presets.clear_cache()
    assert any("Install the extension again" in text for text in record.texts)
    assert not record.named("apply_preset")


def test_the_library_button_follows_the_preferences(registered, monkeypatch, tmp_path):
    from addon.operators import library

    monkeypatch.setattr(library, "_FOLDERS", (tmp_path,))
    assert not registered.ops.microbounce.register_library.poll()
    (tmp_path / library.BLEND).write_bytes(b"")
    library.forget_folders()
    assert draw(registered, PANEL).named("register_library")
    registered.ops.microbounce.register_library()
    record = draw(registered, PANEL)
    assert record.named("unregister_library")
    assert not record.named("register_library")
    registered.ops.microbounce.unregister_library()


def test_the_shader_editor_shows_them_for_materials_of_objects(registered):
    new_object(registered, registered.data.meshes.new("Mesh"))
    cls = registered.types.MICROBOUNCE_PT_shader_editor_presets
    for shader_type, seen in (("OBJECT", True), ("WORLD", False)):
        context = SimpleNamespace(space_data=SimpleNamespace(shader_type=shader_type))
        assert cls.poll(context) is seen
    material, _ = our_material("DIFFUSE")
    space = SimpleNamespace(type="NODE_EDITOR", id=material)
    from addon.operators.presets import shown_material

    other, _ = our_material("CONDUCTOR")
    registered.context.object.data.materials.append(other)
    context = SimpleNamespace(space_data=space, object=registered.context.object)
    assert shown_material(context) == material
    space.id = None
    assert shown_material(context) == other
    context.object = None
    assert shown_material(context) is None


@pytest.mark.parametrize("identifier", ["conductor/unheard-of", ""])
def test_a_missing_picture_is_no_icon(registered, identifier):
    from addon.presets import icons as preset_icons

    assert preset_icons.icon(identifier) == 0


def test_pictures_are_loaded_when_drawn_and_released(empty_file):
    import addon
    from addon.presets import icons as preset_icons

    addon.register()
    try:
        assert preset_icons._icons is None, "nothing is loaded at start-up"
        draw(empty_file, PANEL)
        assert set(preset_icons._icons) == {preset.identifier for preset in presets.presets()}
        assert all(min(icon.image_size) > 0 for icon in preset_icons._icons.values())
    finally:
        addon.unregister()
    assert preset_icons._icons is None


def test_every_kind_can_be_chosen(registered):
    items = registered.types.WindowManager.bl_rna.properties["microbounce_presets_shown"].enum_items
    assert [item.identifier for item in items] == ["MATERIAL", "ALL", *KINDS]
