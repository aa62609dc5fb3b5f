# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups that older versions made are replaced in place, with values, links and animation."""

import pytest

from addon.core.kinds import KINDS
from addon.material.group import STAMP_KEY, VERSION_KEY, material_group
from addon.material.node import new_material
from addon.material.update import old_groups, update_materials
from blender_tests.addon.node_trees import curve_paths
from blender_tests.addon.support import run_blender, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


def make_old(group, version="0.0.9"):
    """Let `group` look like one of an older version: other stamp, one input less, one more."""
    group[STAMP_KEY], group[VERSION_KEY] = "0123456789abcdef", version
    interface = group.interface
    interface.remove(interface.items_tree["Tolerance"])
    socket = interface.new_socket("Sparkle", in_out="INPUT", socket_type="NodeSocketFloat")
    # In front of all others, so that numbers and identifiers of sockets differ from today's.
    interface.move(socket, 0)


def our_node(tree):
    (node,) = [n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    return node


@pytest.fixture
def old_material(empty_file, kind):
    """A material whose group is old, with changed values, links, animation and looks."""
    material = new_material(kind, "Old", Roughness=0.7, Walks=9, Quality="Walk", Tolerance=0.5)
    tree = material.node_tree
    node = our_node(tree)
    make_old(node.node_tree)
    node.inputs["Sparkle"].default_value = 0.25
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs[0], node.inputs["Anisotropy"])
    tree.links.new(noise.outputs[0], node.inputs["Rotation"]).is_muted = True
    node.inputs["Kernel"].keyframe_insert("default_value", frame=1)
    node.name, node.label, node.location, node.width = "Mine", "Shiny", (12, 34), 333
    node.inputs["Model"].hide = True
    return material


def test_a_node_takes_todays_group_in_place(old_material, kind):
    tree = old_material.node_tree
    old = tree.nodes["Mine"].node_tree.name
    done = update_materials()
    node = tree.nodes["Mine"]
    assert (done.nodes, done.stay, done.removed) == (1, [], [old])
    assert node.node_tree == material_group(kind)
    assert {socket.name for socket in node.inputs} == {p.label for p in KINDS[kind].parameters}
    values = {name: node.inputs[name].default_value for name in ("Roughness", "Walks", "Quality")}
    assert values == {"Roughness": pytest.approx(0.7), "Walks": 9, "Quality": 2}
    assert node.inputs["Tolerance"].default_value == pytest.approx(0.001), "new: today's default"
    links = {s.name: (k.from_node.bl_idname, k.is_muted) for s in node.inputs for k in s.links}
    noise = "ShaderNodeTexNoise"
    assert links == {"Anisotropy": (noise, False), "Rotation": (noise, True)}
    assert [k.to_node.bl_idname for k in node.outputs["BSDF"].links] == ["ShaderNodeOutputMaterial"]
    assert (node.label, tuple(node.location), node.width) == ("Shiny", (12, 34), 333)
    assert [s.name for s in node.inputs if s.hide] == ["Model"]
    number = node.inputs.find("Kernel")
    assert curve_paths(tree) == [f'nodes["Mine"].inputs[{number}].default_value']


def test_the_old_group_and_its_text_are_removed_and_their_names_taken(old_material, kind):
    import bpy

    update_materials()
    assert [group.name for group in bpy.data.node_groups] == [KINDS[kind].name]
    assert [text.name for text in bpy.data.texts] == [f"{KINDS[kind].shader}.osl"]
    assert update_materials().nodes == 0


def test_what_has_no_place_any_more_is_told(old_material):
    tree = old_material.node_tree
    node = tree.nodes["Mine"]
    assert update_materials().lost == ["Old, Mine: Sparkle was 0.25"]
    make_old(node.node_tree)
    tree.links.new(tree.nodes.new("ShaderNodeValue").outputs[0], node.inputs["Sparkle"])
    assert update_materials().lost == ["Old, Mine: Sparkle was linked to 'Value'"]
    make_old(node.node_tree)
    node.inputs["Sparkle"].keyframe_insert("default_value", frame=1)
    assert update_materials().lost == ["Old, Mine: Sparkle was animated"]


def test_a_default_that_goes_is_no_loss(empty_file, kind):
    make_old(our_node(new_material(kind, "M").node_tree).node_tree)
    assert update_materials().lost == []


def test_a_socket_of_another_type_is_told(empty_file):
    node = our_node(new_material("CONDUCTOR", "M").node_tree)
    group = node.node_tree
    make_old(group)
    group.interface.remove(group.interface.items_tree["Roughness"])
    group.interface.new_socket("Roughness", in_out="INPUT", socket_type="NodeSocketColor")
    node.inputs["Roughness"].default_value = (0.5, 0.25, 1.0, 1.0)
    assert update_materials().lost == [f"M, {node.name}: Roughness was (0.5, 0.25, 1, 1)"]
    assert node.inputs["Roughness"].default_value == pytest.approx(0.5), "today's default"


def test_groups_shared_by_materials_and_inside_users_groups(empty_file, kind):
    materials = [new_material(kind, name, Roughness=0.1) for name in "ab"]
    group = our_node(materials[0].node_tree).node_tree
    outer = empty_file.data.node_groups.new("Car Paint", "ShaderNodeTree")
    inner = outer.nodes.new("ShaderNodeGroup")
    inner.node_tree = group
    inner.inputs["Roughness"].default_value = 0.3
    make_old(group)
    done = update_materials()
    assert (done.nodes, len(done.removed)) == (3, 1)
    values = [
        our_node(t).inputs["Roughness"].default_value for t in (materials[1].node_tree, outer)
    ]
    assert values == [pytest.approx(0.1), pytest.approx(0.3)]


def test_a_group_with_a_fake_user_stays(old_material):
    group = old_material.node_tree.nodes["Mine"].node_tree
    group.use_fake_user = True
    done = update_materials()
    assert (done.nodes, done.removed) == (1, [])
    assert group.users == 1
    assert old_groups() == [], "there is nothing more to update"


def test_worlds_and_lights(empty_file, kind):
    data = empty_file.data
    old = material_group(kind)
    make_old(old)
    owners = [data.worlds.new("World"), data.lights.new("Light", "POINT")]
    for owner in owners:
        if empty_file.app.version < (5, 0, 0):
            owner.use_nodes = True
        owner.node_tree.nodes.new("ShaderNodeGroup").node_tree = old
    assert old_groups() == [old]
    assert update_materials().nodes == 2
    assert old_groups() == []
    assert {our_node(owner.node_tree).node_tree for owner in owners} == {material_group(kind)}


def test_newer_groups_stay(empty_file):
    material = new_material("CONDUCTOR", "M")
    make_old(our_node(material.node_tree).node_tree, version="99.0.0")
    assert old_groups() == []
    done = update_materials()
    assert done.nodes == 0
    assert "its group is of version 99.0.0: update the extension" in done.stay[0]


def test_the_same_version_with_another_stamp_is_old(empty_file, kind):
    from addon.core import VERSION

    group = our_node(new_material(kind, "M").node_tree).node_tree
    make_old(group, version=VERSION)
    assert old_groups() == [group]


def test_foreign_groups_are_left_alone(empty_file):
    _, tree, _ = surface_material("M")
    tree.nodes.new("ShaderNodeGroup")
    foreign = empty_file.data.node_groups.new("Foreign", "ShaderNodeTree")
    foreign["microbounce_kind"] = "PLASMA"
    tree.nodes.new("ShaderNodeGroup").node_tree = foreign
    done = update_materials()
    assert (done.nodes, done.stay, done.removed) == (0, [], [])


def test_a_damaged_installation_changes_nothing(old_material, monkeypatch):
    from addon.core.shader_source import ShaderSourceError
    from addon.material import update

    def broken(kind):
        raise ShaderSourceError("Reinstall the extension")

    monkeypatch.setattr(update, "material_group", broken)
    node = old_material.node_tree.nodes["Mine"]
    group = node.node_tree
    with pytest.raises(ShaderSourceError):
        update_materials()
    assert node.node_tree == group


def test_linked_materials_and_groups_are_told(empty_file, tmp_path):
    bpy = empty_file
    material = new_material("CONDUCTOR", "Library Metal")
    make_old(our_node(material.node_tree).node_tree)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {material})
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.materials = ["Library Metal"]
    (group,) = bpy.data.node_groups
    _, tree, _ = surface_material("Mine")
    tree.nodes.new("ShaderNodeGroup").node_tree = group
    assert old_groups() == []
    done = update_materials()
    assert done.nodes == 0
    texts = " ".join(sorted(done.stay))
    assert "Library Metal, Microbounce Conductor: it is linked from a library" in texts
    assert "Mine, Group: its group is linked from" in texts


def test_the_operator(registered, capfd, kind):
    operator = registered.ops.microbounce.update_materials
    node = our_node(new_material(kind, "M").node_tree)
    assert not operator.poll()
    with pytest.raises(RuntimeError, match="are of this version"):
        operator()
    make_old(node.node_tree)
    node.inputs["Sparkle"].default_value = 2.0
    assert operator.poll()
    assert operator() == {"FINISHED"}
    text = capfd.readouterr().out
    assert "Sparkle was 2" in text
    assert "Nodes updated: 1; values and links that have no place any more: 1" in text
    assert not operator.poll()


def test_a_file_of_another_version_is_updated_after_loading(tmp_path):
    """The version of the extension that makes the file differs from the one that opens it."""
    path = tmp_path / "old.blend"
    script = f"""
from addon.material import group
from addon.material.node import new_material
group.VERSION = "0.0.1"
material = new_material("DIELECTRIC", "Old", Roughness=0.25)
material.use_fake_user = True
bpy.ops.wm.save_as_mainfile(filepath={str(path)!r})
finish(bpy.data.node_groups[0]["microbounce_stamp"])
"""
    stamp = run_blender(script, tmp_path)
    script = f"""
import addon
addon.register()
bpy.ops.wm.open_mainfile(filepath={str(path)!r})
result = bpy.ops.microbounce.update_materials()
(group,) = bpy.data.node_groups
(node,) = [n for n in bpy.data.materials["Old"].node_tree.nodes if n.type == "GROUP"]
finish([list(result), group["microbounce_stamp"], group["microbounce_version"],
        node.inputs["Roughness"].default_value])
"""
    result, today, version, roughness = run_blender(script, tmp_path)
    assert (result, version, roughness) == (["FINISHED"], "0.1.0", 0.25)
    assert today != stamp
