# SPDX-License-Identifier: GPL-3.0-or-later
"""Which materials a scene shows, and their shares of the picture."""

import itertools
import math

import bpy
import pytest

from addon.analysis.analyse import analyse
from addon.material.node import new_material
from addon.scene import share
from addon.scene.share import SMALLEST_SHARE, Shares, picture_shares, shown_materials
from scenes import common

from ..support import small_scene, surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")


def ball_behind_a_pane() -> bpy.types.Object:
    """Make a small scene's ball of metal; return a pane without a material that hides it."""
    _, ball = small_scene(osl=True)
    ball.data.materials.append(new_material("CONDUCTOR", "Ball"))
    bpy.ops.mesh.primitive_plane_add(size=20, location=(0, -2, 0), rotation=(math.pi / 2, 0, 0))
    return bpy.context.object


def shares() -> dict[str, float]:
    return picture_shares(bpy.context).by_name


def test_shares_are_the_picture(empty_file) -> None:
    """A unit sphere fills pi / 2.1^2 of the fixtures' picture."""
    scene = common.start_scene((64, 64), 1)
    common.add_front_camera(scene)
    material = new_material("CONDUCTOR", "Ball")
    common.add_unit_sphere(material)
    found = picture_shares(bpy.context)
    assert found.by_name["Ball"] == pytest.approx(math.pi / 2.1**2, rel=0.03)
    assert shown_materials(bpy.context) == [material]
    scene.camera.data.type = "PERSP"
    scene.camera.data.angle = 2.0 * math.atan(1.05 / 5.0)
    found = picture_shares(bpy.context)
    assert found.by_name["Ball"] == pytest.approx(math.pi / 2.1**2, rel=0.06)


def test_what_is_not_rendered_or_not_seen_is_not_met(empty_file) -> None:
    front = ball_behind_a_pane()
    front.data.materials.append(new_material("DIFFUSE", "Pane"))
    assert shares() == {"Pane": 1.0}
    front.hide_render = True
    assert set(shares()) == {"Ball"}
    assert [material.name for material in shown_materials(bpy.context)] == ["Ball"]
    front.hide_render, front.visible_camera = False, False
    assert set(shares()) == {"Ball"}
    front.visible_camera = True
    collection = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(front)
    collection.objects.link(front)
    assert set(shares()) == {"Pane"}
    collection.hide_render = True
    assert set(shares()) == {"Ball"}
    assert [material.name for material in shown_materials(bpy.context)] == ["Ball"]


def native(name: str, kind: str, **values: object) -> bpy.types.Material:
    """Return a material of one node of Blender's own."""
    material, tree, output = surface_material(name)
    node = tree.nodes.new(kind)
    for label, value in values.items():
        node.inputs[label.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def fog() -> bpy.types.Material:
    material, tree, output = surface_material("Fog")
    node = tree.nodes.new("ShaderNodeVolumeScatter")
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return material


@pytest.mark.parametrize(
    "make",
    [
        lambda: new_material("DIELECTRIC", "Glass"),
        lambda: native("Glass", "ShaderNodeBsdfGlass"),
        lambda: native("Leaf", "ShaderNodeBsdfTransparent"),
        lambda: native("Window", "ShaderNodeBsdfPrincipled", Transmission_Weight=1.0),
        lambda: native("Veil", "ShaderNodeBsdfPrincipled", Alpha=0.5),
        fog,
    ],
    ids=["ours", "glass", "transparent", "transmission", "alpha", "fog"],
)
def test_rays_go_on_through_what_is_clear(empty_file, make) -> None:
    """What is seen through it counts beside it."""
    front = ball_behind_a_pane()
    front.data.materials.append(make())
    found = shares()
    assert found[front.data.materials[0].name] == 1.0
    assert 0.02 < found["Ball"] < 0.9


@pytest.mark.parametrize(
    "make",
    [
        lambda: new_material("DIFFUSE", "Plaster"),
        lambda: new_material("CONDUCTOR", "Mirror", Roughness=0.0),
        lambda: native("Plastic", "ShaderNodeBsdfPrincipled", Roughness=0.0),
        lambda: bpy.data.materials.new("Bare"),
    ],
    ids=["matte", "mirror", "plastic", "bare"],
)
def test_rays_do_not_go_through_the_others(empty_file, make) -> None:
    front = ball_behind_a_pane()
    front.data.materials.append(make())
    assert "Ball" not in shares()


@pytest.mark.parametrize(
    "make",
    [
        lambda roughness: new_material("CONDUCTOR", "Mirror", Roughness=roughness),
        lambda roughness: native(
            "Mirror", "ShaderNodeBsdfPrincipled", Metallic=1.0, Roughness=roughness
        ),
        lambda roughness: native("Mirror", "ShaderNodeBsdfGlossy", Roughness=roughness),
    ],
    ids=["ours", "principled", "glossy"],
)
def test_what_a_mirror_shows_counts(empty_file, make) -> None:
    """The ball stands behind the camera, before a mirror that fills the picture."""
    front = ball_behind_a_pane()
    bpy.data.objects["Sphere"].location = (0, -9, 1)
    front.data.materials.append(make(0.05))
    found = shares()
    assert found["Mirror"] == 1.0
    assert 0.01 < found["Ball"] < 0.5
    front.data.materials[0] = make(0.9)
    assert "Ball" not in shares()


def test_what_rays_cannot_meet_has_an_equal_part(empty_file) -> None:
    """Hair, and what the viewport hides but is rendered."""
    scene, ball = small_scene(osl=True)
    ball.data.materials.append(new_material("CONDUCTOR", "Ball"))
    hair = bpy.data.objects.new("Hair", bpy.data.hair_curves.new("Hair"))
    hair.data.materials.append(new_material("CONDUCTOR", "Hair"))
    hidden = bpy.data.objects.new("Hidden", ball.data.copy())
    hidden.data.materials[0] = new_material("CONDUCTOR", "Hidden")
    hidden.hide_viewport = True
    for thing in (hair, hidden):
        scene.collection.objects.link(thing)
    found = picture_shares(bpy.context)
    assert found.unmet == {"Hair", "Hidden"}
    assert found.of([bpy.data.materials["Hair"]], 4) == 0.25
    report = analyse(bpy.context, 0.01)
    rows = {row.name: row for row in report.rows}
    assert set(rows) == {"Ball", "Hair", "Hidden"}
    assert rows["Hidden"].proposal.share == pytest.approx(1 / 3)
    assert rows["Hidden"].notes == (
        "Rays cannot meet all that shows it: its share is at least 1 of 3",
    )
    assert rows["Ball"].notes == ()


def test_it_ends_in_time_with_rays_from_all_over(empty_file) -> None:
    scene = common.start_scene((64, 64), 1)
    common.add_front_camera(scene)
    common.add_unit_sphere(new_material("CONDUCTOR", "Ball"))
    told: list[float] = []
    whole = picture_shares(bpy.context, told.append)
    assert whole.part == 1.0
    assert told[0] == 0.0
    assert told == sorted(told)
    assert picture_shares(bpy.context, seconds=0.0).part == pytest.approx(1.0 / 64**2)
    beginning = [n % 64 for n in itertools.islice(share._spread(64**2), 128)]
    assert len(set(beginning)) > 48
    assert sorted(share._spread(1)) == [0]
    assert sorted(share._spread(2560)) == list(range(2560))


def test_what_the_layer_excludes_is_not_analysed(empty_file) -> None:
    scene, ball = small_scene(osl=True)
    ball.data.materials.append(new_material("CONDUCTOR", "Ball"))
    collection = bpy.data.collections.new("Spare")
    scene.collection.children.link(collection)
    spare = bpy.data.objects.new("Spare", ball.data.copy())
    spare.data.materials[0] = new_material("DIFFUSE", "Spare")
    collection.objects.link(spare)
    assert {m.name for m in shown_materials(bpy.context)} == {"Ball", "Spare"}
    bpy.context.view_layer.layer_collection.children["Spare"].exclude = True
    assert {m.name for m in shown_materials(bpy.context)} == {"Ball"}


def test_curves_and_geometry_nodes_have_their_materials(empty_file) -> None:
    """A filled curve of two materials, and a plane whose material geometry nodes give."""
    scene = common.start_scene((64, 64), 1)
    common.add_front_camera(scene)
    bpy.ops.curve.primitive_bezier_circle_add(rotation=(math.pi / 2, 0, 0), radius=0.5)
    curve = bpy.context.object.data
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    for name in ("First", "Second"):
        curve.materials.append(new_material("CONDUCTOR", name))
    curve.splines[0].material_index = 1
    assert shares() == pytest.approx({"Second": math.pi * 0.25 / 2.1**2}, rel=0.1)
    bpy.ops.mesh.primitive_plane_add(size=4, location=(0, -1, 0), rotation=(math.pi / 2, 0, 0))
    given = new_material("DIFFUSE", "Given")
    set_material(bpy.context.object, given)
    assert shares() == {"Given": 1.0}
    assert given in shown_materials(bpy.context)


def set_material(thing: bpy.types.Object, material: bpy.types.Material) -> None:
    tree = bpy.data.node_groups.new("Set", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    inner = tree.nodes.new("GeometryNodeSetMaterial")
    inner.inputs["Material"].default_value = material
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(start.outputs[0], inner.inputs["Geometry"])
    tree.links.new(inner.outputs[0], end.inputs[0])
    thing.modifiers.new("Set", "NODES").node_group = tree


def test_instances_and_faces_have_their_materials(empty_file) -> None:
    """A collection instance of a cube whose faces have two materials."""
    scene = common.start_scene((64, 64), 1)
    common.add_front_camera(scene)
    mesh = bpy.data.meshes.new("Tiles")
    mesh.from_pydata(
        [(-1, 0, -1), (0, 0, -1), (0, 0, 1), (-1, 0, 1), (1, 0, -1), (1, 0, 1)],
        [],
        [(0, 1, 2, 3), (1, 4, 5, 2)],
    )
    for kind in ("CONDUCTOR", "DIFFUSE"):
        mesh.materials.append(new_material(kind, kind))
    mesh.polygons[1].material_index = 1
    collection = bpy.data.collections.new("Set")
    collection.objects.link(bpy.data.objects.new("Tiles", mesh))
    holder = common.add_object("Holder", None)
    holder.instance_type, holder.instance_collection = "COLLECTION", collection
    found = picture_shares(bpy.context).by_name
    half = 2.0 / 2.1**2
    assert found == pytest.approx({"CONDUCTOR": half, "DIFFUSE": half}, rel=0.05)
    assert {m.name for m in shown_materials(bpy.context)} == {"CONDUCTOR", "DIFFUSE"}


def test_without_a_camera_all_weigh_the_same(empty_file) -> None:
    found = picture_shares(bpy.context)
    assert not found.has_camera
    assert found.of([], 4) == 0.25
    assert Shares({}).of([], 4) == SMALLEST_SHARE
