# SPDX-License-Identifier: GPL-3.0-or-later
"""The check before rendering: pictures and libraries, which are files."""

import pytest

from addon.core.kinds import KINDS
from blender_tests.addon.scene.test_before_render import check, no_bytecode, older, the_finding
from blender_tests.addon.support import give_material, small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


def test_a_missing_picture_is_named_with_its_path(osl_scene, tmp_path):
    import bpy

    path = tmp_path / "wear.png"
    image = bpy.data.images.new("Wear", 2, 2)
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    image.source = "FILE"
    tree = give_material().node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    assert check(osl_scene) == ()
    path.unlink()
    assert check(osl_scene) == (), "nothing uses it"
    tree.links.new(node.outputs[0], tree.nodes["Microbounce Conductor"].inputs["Roughness"])
    finding = the_finding(osl_scene)
    assert (finding.level, finding.subject) == ("warning", "Image 'Wear' of material 'Ours'")
    assert finding.message == f"Its file {path} is missing."
    assert "Put the file back" in finding.remedy
    node.mute = True
    assert check(osl_scene) == ()


def linked(tmp_path, prepare=lambda group: None):
    """A scene whose sphere has a local material around a group linked from a library."""
    import bpy

    from addon.material.group import add_group_node, material_group

    bpy.ops.wm.read_factory_settings(use_empty=True)
    group = material_group("CONDUCTOR")
    prepare(group)
    path = tmp_path / "library.blend"
    bpy.data.libraries.write(str(path), {group})
    scene, ball = small_scene(osl=True)
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.node_groups = [KINDS["CONDUCTOR"].name]
    material, tree, output = surface_material("Ours")
    node = add_group_node(tree, bpy.data.node_groups[KINDS["CONDUCTOR"].name])
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    ball.data.materials.append(material)
    return scene, path


def test_a_linked_group(registered, tmp_path):
    scene, _ = linked(tmp_path)
    assert check(scene) == ()


def test_a_linked_group_of_another_version(registered, tmp_path):
    scene, _ = linked(tmp_path, older)
    finding = the_finding(scene)
    assert (finding.level, finding.subject) == ("note", "Material 'Ours'")
    assert "Update Materials in the library file" in finding.remedy


def test_a_linked_group_without_bytecode(registered, tmp_path):
    scene, _ = linked(tmp_path, no_bytecode)
    finding = the_finding(scene)
    assert finding.level == "warning"
    assert "Open the library file" in finding.remedy


def test_a_missing_library(registered, tmp_path):
    import bpy

    _, library = linked(tmp_path)
    user = str(tmp_path / "user.blend")
    bpy.ops.wm.save_as_mainfile(filepath=user)
    library.unlink()
    bpy.ops.wm.open_mainfile(filepath=user)
    finding = the_finding(bpy.context.scene)
    assert finding.level == "error"
    assert "library file of its node group is missing" in finding.message
    assert "Find Missing Files" in finding.remedy
