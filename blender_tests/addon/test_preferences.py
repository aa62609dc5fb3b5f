# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences: defaults without an entry of Blender's, and what new nodes take from them."""

import pytest

from addon.core.kinds import KINDS
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


def current(bpy):
    from addon.preferences import preferences

    return preferences(bpy.context)


def quality_of(tree):
    (node,) = [n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    return node.inputs["Quality"].default_value


def test_without_an_entry_the_defaults_hold(registered):
    from addon.preferences import Preferences

    assert "addon" not in registered.context.preferences.addons
    assert current(registered) == Preferences("Fitted", 0.01, "")


def test_the_stored_ones_start_from_the_same_defaults(registered, stored):
    from addon.preferences import Preferences

    assert current(registered).tolerance == pytest.approx(Preferences().tolerance)
    assert current(registered).quality == Preferences().quality
    assert current(registered).library_path == Preferences().library_path


def test_an_entry_without_values_gives_the_defaults(empty_file):
    """So it is while the extension is being enabled, before its classes are registered."""
    from addon.preferences import Preferences

    addons = empty_file.context.preferences.addons
    addons.new().module = "addon"
    assert addons["addon"].preferences is None
    assert current(empty_file) == Preferences()
    addons.remove(addons["addon"])


def test_default_quality_is_that_of_the_parameter(kind):
    from addon.preferences import Preferences

    quality = KINDS[kind].by_identifier["Quality"]
    assert quality.checked(Preferences().quality) == quality.default


def test_values_are_held_to_their_ranges(registered, stored):
    stored.tolerance = -1.0
    assert current(registered).tolerance == pytest.approx(5e-4)
    stored.tolerance = 9.0
    assert current(registered).tolerance == 1.0
    with pytest.raises(TypeError, match="not found in"):
        stored.quality = "Best"
    stored.library_path = "/library"
    assert current(registered).library_path == "/library"


@pytest.mark.parametrize(("quality", "number"), [("Single", 0), ("Fitted", 1), ("Exact", 3)])
def test_new_materials_take_the_quality(registered, stored, kind, quality, number):
    bpy = registered
    stored.quality = quality
    obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.microbounce.add_material(kind=kind) == {"FINISHED"}
    assert quality_of(obj.active_material.node_tree) == number
    (group,) = bpy.data.node_groups
    default = next(i for i in group.interface.items_tree if i.name == "Quality").default_value
    assert default == 1, "the group itself is the same for all"


def test_new_nodes_take_the_quality(registered, stored, kind):
    bpy = registered
    stored.quality = "Walk"
    _, tree, _ = surface_material("Metal")
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    before = area.ui_type
    area.ui_type = "ShaderNodeTree"
    space = area.spaces.active
    space.pin, space.node_tree = True, tree
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        assert bpy.ops.microbounce.add_node(kind=kind) == {"FINISHED"}
    assert quality_of(tree) == 2
    space.node_tree, space.pin = None, False
    area.ui_type = before


@pytest.mark.parametrize("replaces", [False, True], ids=["empty slot", "native material"])
def test_presets_take_the_quality_for_a_new_node(registered, stored, replaces):
    bpy = registered
    stored.quality = "Walk"
    obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    if replaces:
        obj.data.materials.append(surface_material("Native")[0])
    assert bpy.ops.microbounce.apply_preset(identifier="conductor/gold") == {"FINISHED"}
    assert quality_of(obj.active_material.node_tree) == 2


def test_a_preset_leaves_the_quality_of_a_node_that_is_there(registered, stored):
    bpy = registered
    obj = bpy.data.objects.new("Thing", bpy.data.meshes.new("Mesh"))
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.microbounce.apply_preset(identifier="conductor/gold")
    stored.quality = "Walk"
    bpy.ops.microbounce.apply_preset(identifier="conductor/silver")
    assert quality_of(obj.active_material.node_tree) == 1


def test_the_command_line_knows_no_preferences(registered, stored, command, tmp_path):
    """A farm gives the same as the artist's machine."""
    bpy = registered
    stored.quality = "Walk"
    surface_material("Metal")
    bpy.data.materials["Metal"].use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    code, _, err = command("preset", "conductor/gold", "--material", "Metal", "--save")
    assert code == 0, err
    assert quality_of(bpy.data.materials["Metal"].node_tree) == 1


def test_they_can_be_drawn(registered, stored):
    from addon.preferences import MicrobouncePreferences

    class Layout:
        def __init__(self):
            self.drawn = []

        def prop(self, data, name):
            self.drawn.append(data.bl_rna.properties[name].name)

    layout = Layout()
    # Blender's own class hands out its layout only while it draws.
    MicrobouncePreferences.draw(_With(stored, layout), registered.context)
    assert layout.drawn == ["Quality", "Tolerance", "Asset Library"]
    assert layout.use_property_split


class _With:
    """The preferences with another layout."""

    def __init__(self, stored, layout):
        self.bl_rna, self.layout = stored.bl_rna, layout
