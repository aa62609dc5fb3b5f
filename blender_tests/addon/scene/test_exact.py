# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights that a material of quality Exact misses are named, with the remedy."""

import math

import pytest

from addon.core.lamps import Lamp, exact_warning
from blender_tests.addon.support import render, small_scene

pytestmark = pytest.mark.usefixtures("compiled_once")


@pytest.mark.parametrize(
    ("lamp", "words"),
    [
        (Lamp("Key", "SUN", 0.0), "'Key' (angle 0)"),
        (Lamp("Key", "POINT", 0.0), "'Key' (radius 0)"),
        (Lamp("Key", "SPOT", 0.0), "'Key' (radius 0)"),
        (Lamp("Key", "AREA", 0.0), "'Key' (size 0)"),
        (Lamp("Key", "AREA", 1.0, False), "'Key' (Multiple Importance off)"),
    ],
)
def test_light_that_no_path_hits_is_named(lamp, words):
    warning = exact_warning([Lamp("Fill", "AREA", 1.0), lamp])
    assert words in warning
    assert "Fill" not in warning
    assert "set Quality to Walk" in warning
    remedy = "give them a size" if lamp.multiple_importance else "switch their Multiple Importance"
    assert remedy in warning


def test_lights_that_paths_hit_give_no_warning():
    assert exact_warning([]) == ""
    assert exact_warning([Lamp("Sun", "SUN", 0.01), Lamp("Area", "AREA", 1.0)]) == ""


def test_many_lights_are_counted():
    warning = exact_warning([Lamp(f"Lamp {number}", "POINT", 0.0) for number in range(30)])
    assert "'Lamp 3' (radius 0), 26 more. Remedy" in warning
    assert "Lamp 4" not in warning


# Mean radiance of a picture that no light reaches. Glass has a little: exits that turn a path by a
# right angle or more have no mirror and take a smooth lobe. Lit pictures have 0.01 and more.
DARKEST = {"CONDUCTOR": 0.0, "DIELECTRIC": 5e-4, "DIFFUSE": 0.0}


def add_light(bpy, name, kind, size=0.0, **values):
    light = bpy.data.lights.new(name, kind)
    if kind == "SUN":
        light.angle = size
    elif kind == "AREA":
        light.size = size
    else:
        light.shadow_soft_size = size
    for key, value in values.items():
        setattr(light, key, value)
    obj = bpy.data.objects.new(name, light)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def missed(bpy):
    """Names of the lights that Exact misses in the current view layer."""
    from addon.scene.exact import enabled_lamps

    return {lamp.name for lamp in enabled_lamps(bpy.context.view_layer) if lamp.why_missed}


def test_lights_of_the_scene_are_read(empty_file):
    bpy = empty_file
    add_light(bpy, "Hard Sun", "SUN")
    add_light(bpy, "Soft Sun", "SUN", math.radians(0.5))
    add_light(bpy, "Hard Point", "POINT")
    add_light(bpy, "Soft Point", "POINT", 0.1)
    add_light(bpy, "Hard Spot", "SPOT")
    add_light(bpy, "Area", "AREA", 1.0)
    line = add_light(bpy, "Line", "AREA", 1.0, shape="RECTANGLE")
    line.data.size_y = 0.0
    add_light(bpy, "Alone", "AREA", 1.0).data.cycles.use_multiple_importance_sampling = False
    add_light(bpy, "Portal", "AREA", 0.0).data.cycles.is_portal = True
    add_light(bpy, "Out", "POINT", energy=0.0)
    expected = {"Hard Sun", "Hard Point", "Hard Spot", "Alone"}
    # Blender may keep the side of an area light above 0.
    expected |= {"Line"} if line.data.size_y == 0.0 else set()
    assert missed(bpy) == expected


def test_only_lights_that_render_count(empty_file):
    bpy = empty_file
    scene, layer = bpy.context.scene, bpy.context.view_layer
    lamp = add_light(bpy, "Lamp", "POINT")
    assert missed(bpy) == {"Lamp"}
    lamp.hide_render = True
    assert missed(bpy) == set()
    lamp.hide_render = False
    collection = bpy.data.collections.new("Lights")
    scene.collection.children.link(collection)
    collection.objects.link(lamp)
    scene.collection.objects.unlink(lamp)
    assert missed(bpy) == {"Lamp"}
    collection.hide_render = True
    assert missed(bpy) == set()
    collection.hide_render = False
    layer.layer_collection.children["Lights"].exclude = True
    assert missed(bpy) == set()
    # An instance of the excluded collection still shines.
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type = "COLLECTION"
    instance.instance_collection = collection
    scene.collection.objects.link(instance)
    assert missed(bpy) == {"Lamp"}
    instance.hide_render = True
    assert missed(bpy) == set()


@pytest.fixture
def exact(empty_file, kind):
    """A material of ours and its node, for each kind."""
    from addon.material.node import new_material

    material = new_material(kind, "New", Quality="Exact")
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    return material, node


def test_exact_is_found_on_the_node(exact):
    from addon.scene.exact import uses_exact

    material, node = exact
    assert uses_exact(material.node_tree)
    node.mute = True
    assert not uses_exact(material.node_tree)
    node.mute = False
    node.inputs["Quality"].default_value = 2
    assert not uses_exact(material.node_tree)


def test_exact_is_found_within_a_users_group_but_not_behind_a_link(exact, empty_file):
    from addon.material.group import add_group_node
    from addon.scene.exact import uses_exact

    _, node = exact
    outer = empty_file.data.node_groups.new("Mine", "ShaderNodeTree")
    inner = add_group_node(outer, node.node_tree)
    inner.inputs["Quality"].default_value = 3
    tree = empty_file.data.materials.new("Other").node_tree or use_nodes(empty_file, "Other")
    tree.nodes.new("ShaderNodeGroup")  # one without a group
    tree.nodes.new("ShaderNodeGroup").node_tree = outer
    assert uses_exact(tree)
    value = outer.nodes.new("ShaderNodeValue")
    outer.links.new(value.outputs[0], inner.inputs["Quality"])
    assert not uses_exact(tree)


def use_nodes(bpy, name):
    material = bpy.data.materials[name]
    material.use_nodes = True
    return material.node_tree


def test_enabling_osl_warns_of_lights_that_exact_misses(registered, exact, capfd):
    bpy = registered
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    mesh = bpy.data.meshes.new("Mesh")
    mesh.materials.append(exact[0])
    obj = bpy.data.objects.new("Thing", mesh)
    scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    add_light(bpy, "Sun", "SUN")
    assert bpy.ops.microbounce.enable_osl() == {"FINISHED"}
    assert "Warning: Quality Exact finds lights only by hitting them" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("lamp", "size", "importance"),
    [
        ("SUN", 0.0, True),
        ("POINT", 0.0, True),
        ("SPOT", 0.0, True),
        ("POINT", 1.0, False),
        ("SUN", 0.5, True),
        ("POINT", 1.0, True),
        ("SPOT", 1.0, True),
        ("AREA", 1.0, True),
        ("AREA", 1.0, False),
    ],
)
def test_what_is_named_is_what_cycles_misses(kind, lamp, size, importance, tmp_path):
    import bpy

    from addon.material.node import new_material

    _, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material(kind, "New", Quality="Exact", Roughness=0.8))
    bpy.data.objects.remove(bpy.data.objects["Area"])
    bpy.context.scene.world = None
    bpy.context.scene.cycles.samples = 64
    light = add_light(bpy, "Key", lamp, size, energy=10.0 if lamp == "SUN" else 1000.0)
    light.data.cycles.use_multiple_importance_sampling = importance
    light.location = (1.5, -3, 2)
    light.rotation_euler = (0.98, 0, 0.46)  # towards the sphere
    picture = render(tmp_path / "lit.exr")
    dark = picture.mean() <= DARKEST[kind]
    assert dark == (missed(bpy) == {"Key"})
    assert dark == (size == 0.0 or not importance)
