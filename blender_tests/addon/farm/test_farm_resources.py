# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: images, drivers, texts and libraries that a file needs."""

import bpy
import pytest

from blender_tests.addon.farm.farm_scene import OurScene, findings, the_finding
from blender_tests.addon.support import small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def scene(registered):
    """A clean scene with our matte material."""
    return OurScene("DIFFUSE")


def add_image(scene, image):
    tree = scene.material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs[0], tree.nodes["Microbounce Diffuse"].inputs["Color"])
    return node


def test_images_that_are_not_in_the_file(scene, tmp_path):
    data = bpy.data
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
    node.mute = True
    assert the_finding(scene.scene)[1] == "File", "these materials do without"
    node.mute = False
    node.image = data.images.new("Generated", 2, 2)
    assert findings(scene.scene) == []
    node.image.pixels[0] = 0.5
    assert "not saved" in the_finding(scene.scene)[2]
    node.image.pack()
    assert findings(scene.scene) == []


def test_tiled_images(scene, tmp_path):
    image = bpy.data.images.new("Tiles", 2, 2)
    image.filepath_raw = str(tmp_path / "tiles.1001.png")
    image.file_format = "PNG"
    image.save()
    image.source = "TILED"
    image.filepath = str(tmp_path / "tiles.<UDIM>.png")
    add_image(scene, image)
    assert "outside this one" in the_finding(scene.scene)[2]
    (tmp_path / "tiles.1001.png").unlink()
    assert "tiles.<UDIM>.png is missing" in the_finding(scene.scene)[2]


def test_files_beside_the_materials(scene, tmp_path):
    data = bpy.data
    sky = data.images.new("Sky", 2, 2)
    sky.filepath_raw, sky.file_format = str(tmp_path / "sky.png"), "PNG"
    sky.save()
    sky.source, sky.filepath = "FILE", str(tmp_path / "sky.png")
    assert findings(scene.scene) == [], "nothing uses it"
    sky.use_fake_user = True
    level, _, message = the_finding(scene.scene)
    assert level == "note", "a farm may have it"
    assert str(tmp_path / "sky.png") in message
    for number in range(7):
        volume = data.volumes.new(f"Smoke {number}")
        volume.filepath = str(tmp_path / f"gone {number}.vdb")
        volume.use_fake_user = True
    missing, there = findings(scene.scene)
    assert (missing.level, there.level) == ("warning", "note")
    assert "gone 4.vdb and 2 more." in missing.message
    assert missing.remedy
    assert there.message == message
    sky.pack()
    assert "sky" not in the_finding(scene.scene)[2]


def test_nodes_that_read_files(scene, tmp_path):
    profile = tmp_path / "lamp.ies"
    profile.write_text("IESNA")
    lamp = next(light for light in bpy.data.lights if light.users)
    if bpy.app.version < (5, 0, 0):
        lamp.use_nodes = True
    node = lamp.node_tree.nodes.new("ShaderNodeTexIES")
    assert findings(scene.scene) == []
    node.mode, node.filepath = "EXTERNAL", str(profile)
    level, subject, message = the_finding(scene.scene)
    assert (level, subject) == ("warning", f"Node '{node.name}' of '{lamp.name}'")
    assert message == f"It reads the file {profile}, outside this one."
    profile.unlink()
    assert "which is missing" in the_finding(scene.scene)[2]
    node.mode = "INTERNAL"
    node = scene.material.node_tree.nodes.new("ShaderNodeScript")
    node.mode, node.filepath = "EXTERNAL", str(tmp_path / "dust.osl")
    assert "dust.osl, which is missing" in the_finding(scene.scene)[2]


def drive(socket, expression):
    driver = socket.driver_add("default_value").driver
    driver.type = "SCRIPTED"
    driver.expression = expression


def test_drivers_that_are_python(scene):
    node = scene.material.node_tree.nodes["Microbounce Diffuse"]
    drive(node.inputs["Roughness"], "sin(frame) * 0.5")
    assert findings(scene.scene) == [], "a simple expression needs no Python"
    drive(node.inputs["Anisotropy"], "len(bpy.data.objects)")
    level, subject, message = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Driver of material 'Ours'")
    assert "len(bpy.data.objects)" in message


def test_texts_that_need_the_extension(scene):
    text = bpy.data.texts.new("start.py")
    text.from_string("import bl_ext.user_default.microbounce\n")
    assert findings(scene.scene) == []
    text.use_module = True
    level, subject, _ = the_finding(scene.scene)
    assert (level, subject) == ("warning", "Text 'start.py'")


def linked(scene, tmp_path, relative, what="materials"):
    """Link our material, or its group, from a library into a new file beside it and open it."""
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


def reopened():
    """Load the file again, as it was saved; return its scene."""
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    return bpy.context.scene


@pytest.mark.parametrize("relative", [True, False])
@pytest.mark.parametrize("what", ["materials", "node_groups"])
def test_libraries(scene, tmp_path, what, relative):
    user, library = linked(scene, tmp_path, relative=relative, what=what)
    path = "//library.blend" if relative else str(library)
    level, subject, message = the_finding(user)
    assert (level, subject) == ("warning", f"Library '{path}'")
    assert "A farm needs this file too" in message
    assert "'Microbounce Diffuse'" in message
    library.unlink()
    level, subject, message = the_finding(reopened())
    assert (level, subject) == ("error", f"Library '{path}'")
    assert "is missing, and with it '" in message


def linked_prop(tmp_path):
    """A file of ours with a prop that is linked and has nothing of ours; the library's path."""
    library, user = tmp_path / "prop.blend", tmp_path / "user.blend"
    prop = bpy.data.objects.new("Prop", bpy.data.meshes.new("Mesh"))
    bpy.data.libraries.write(str(library), {prop})
    bpy.ops.wm.save_as_mainfile(filepath=str(user))
    with bpy.data.libraries.load(str(library), link=True, relative=True) as (_, wanted):
        wanted.objects = ["Prop"]
    bpy.data.objects.remove(prop)
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.ops.wm.save_as_mainfile(filepath=str(user))
    return library


@pytest.mark.parametrize("ours", [True, False])
def test_a_prop_in_a_library(scene, tmp_path, ours):
    if not ours:
        scene.sphere.data.materials.clear()
        bpy.data.materials.remove(scene.material)
    library = linked_prop(tmp_path)
    level, subject, message = the_finding(reopened())
    assert (level, subject) == ("warning", "Library '//prop.blend'")
    assert "'Prop'" in message
    library.unlink()
    level, _, message = the_finding(reopened())
    assert (level, message) == ("error", "It is missing, and with it 'Prop'.")


def test_a_library_without_what_is_linked(scene, tmp_path):
    library = linked_prop(tmp_path)
    bpy.data.libraries.write(str(library), {bpy.data.meshes.new("Other")})
    level, _, message = the_finding(reopened())
    assert (level, message) == ("error", "It holds no 'Prop', which this file needs.")


def test_packing_or_making_local_is_a_remedy(scene, tmp_path):
    library = linked_prop(tmp_path)
    bpy.ops.file.pack_libraries()
    bpy.ops.wm.save_mainfile()
    library.rename(library.with_name("elsewhere.blend"))
    assert findings(reopened()) == [], "it is in the file"
    assert not bpy.data.objects["Prop"].is_missing
    bpy.data.objects["Prop"].make_local()
    bpy.data.objects["Prop"].data.make_local()
    assert findings(bpy.context.scene) == []


def test_single_data_blocks_that_are_packed(scene, tmp_path):
    library = linked_prop(tmp_path)
    if bpy.app.version < (5, 0, 0):
        assert not hasattr(bpy.data, "pack_linked_ids_hierarchy")
        return
    prop = bpy.data.objects["Prop"]
    prop.user_remap(bpy.data.pack_linked_ids_hierarchy(prop))
    bpy.ops.wm.save_mainfile()
    library.unlink()
    assert findings(reopened()) == []
    assert bpy.data.objects["Prop"].is_linked_packed


def test_a_picture_of_a_linked_prop(scene, tmp_path):
    library, user = tmp_path / "prop.blend", tmp_path / "user.blend"
    sky = bpy.data.images.new("Sky", 2, 2)
    sky.source, sky.filepath = "FILE", str(tmp_path / "gone.png")
    bpy.data.libraries.write(str(library), {sky}, fake_user=True)
    bpy.data.images.remove(sky)
    bpy.ops.wm.save_as_mainfile(filepath=str(user))
    with bpy.data.libraries.load(str(library), link=True, relative=True) as (_, wanted):
        wanted.images = ["Sky"]
    scene.scene["picture"] = wanted.images[0]
    bpy.ops.file.pack_libraries()
    assert "gone.png" in the_finding(scene.scene)[2], "packing a library leaves its files out"


def test_the_command_fails_where_a_library_is_needed(scene, tmp_path, command):
    library = linked_prop(tmp_path)
    path = bpy.data.filepath
    assert command("check", "--file", path)[0] == 1
    library.unlink()
    code, out, _ = command("check", "--file", path)
    assert code == 1
    assert "Error: Library '//prop.blend': It is missing, and with it 'Prop'." in out
