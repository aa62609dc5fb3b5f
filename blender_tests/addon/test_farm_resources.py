# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: images, drivers, texts and libraries that a file needs."""

import bpy
import pytest

from blender_tests.addon.farm_scene import OurScene, findings, the_finding
from blender_tests.addon.support import small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.fixture
def scene(registered):
    """A clean scene with our matte material."""
    return OurScene("DIFFUSE")


def add_image(scene, image):
    node = scene.material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
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


@pytest.mark.parametrize("what", ["materials", "node_groups"])
def test_libraries(scene, tmp_path, what):
    user, library = linked(scene, tmp_path, relative=True, what=what)
    level, subject, message = the_finding(user)
    assert (level, subject) == ("note", "Library '//library.blend'")
    assert "'Microbounce Diffuse'" in message
    library.unlink()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    found = findings(bpy.context.scene)
    assert [(f.level, f.subject) for f in found] == [("error", "Library '//library.blend'")]
    assert "is missing" in found[0].message


def test_a_library_by_an_absolute_path(scene, tmp_path):
    user, library = linked(scene, tmp_path, relative=False)
    level, subject, message = the_finding(user)
    assert (level, subject) == ("warning", f"Library '{library}'")
    assert "absolute path" in message
