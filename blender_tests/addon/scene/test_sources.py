# SPDX-License-Identifier: GPL-3.0-or-later
"""What the analysis reads of images and animation, and what it says where it cannot."""

import bpy
import pytest

from addon.analysis.surfaces import found_nodes, read_surface
from addon.core.intervals import ANYTHING
from addon.scene.sources import Sources

from ..analysis.analysis_support import image, linked_range, surface_of, textured

pytestmark = pytest.mark.usefixtures("compiled_once")


def test_a_missing_image_can_be_anything(metal) -> None:
    material, tree, node = metal
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], node.inputs["Roughness"])
    surface, notes = surface_of(material)
    assert surface.roughness == (0.0, 1.0)
    assert notes == ("Roughness is unknown, taken as 0 to 1: an image texture has no image",)


def test_a_lost_file_can_be_anything(metal, tmp_path) -> None:
    material, tree, node = metal
    path = tmp_path / "slope.png"
    made = image(0.2, 0.7)
    made.filepath_raw, made.file_format = str(path), "PNG"
    made.save()
    kept = bpy.data.images.load(str(path))
    kept.colorspace_settings.name = "Non-Color"
    tree.links.new(textured(tree, kept), node.inputs["Roughness"])
    assert surface_of(material)[0].roughness == pytest.approx((0.2, 0.7), abs=0.01)
    assert not kept.has_data  # it is not kept in memory
    path.unlink()
    kept.reload()
    surface, notes = surface_of(material)
    assert surface.roughness == (0.0, 1.0)
    assert notes == (
        "Roughness is unknown, taken as 0 to 1: "
        "the file of the image 'slope.png' is missing or cannot be read",
    )


def test_what_cannot_be_read_says_why(metal) -> None:
    material, tree, node = metal
    made = image(0.2, 0.7)
    tree.links.new(textured(tree, made), node.inputs["Roughness"])
    (found,) = found_nodes([material])
    for changed, why in (
        ({"space": "Filmic Log"}, "the image 'Slope' is in the colour space Filmic Log"),
        ({"source": "TILED"}, "the image 'Slope' is tiled"),
    ):
        made.colorspace_settings.name = changed.get("space", "Non-Color")
        made.source = changed.get("source", made.source)
        _, (note,) = read_surface(found)
        assert note == f"Roughness is unknown, taken as 0 to 1: {why}"
    late = Sources(seconds=-1.0)
    assert read_surface(found, late)[1][0].endswith("there was no time to read the image 'Slope'")
    assert late.unread == {"Slope"}


def test_an_image_is_read_once(metal, monkeypatch) -> None:
    """However many inputs and materials share it."""
    from addon.scene import sources

    times = []
    monkeypatch.setattr(sources, "image_range", lambda one: times.append(one) or ((0.2, 0.4),) * 4)
    _, tree, node = metal
    output = textured(tree, image(0.2, 0.7))
    for name in ("Roughness", "Anisotropy", "Base Color"):
        tree.links.new(output, node.inputs[name])
    other = metal[0].copy()
    once = Sources()
    for found in found_nodes([metal[0], other]):
        assert read_surface(found, once)[0].roughness == (0.2, 0.4)
    assert len(times) == 1


def test_keys_give_the_range_of_all_frames(metal) -> None:
    """Of a Bezier that is the one of its handles too."""
    material, tree, node = metal
    rough = node.inputs["Roughness"]
    for frame, value in ((1, 0.1), (50, 0.5)):
        rough.default_value = value
        rough.keyframe_insert("default_value", frame=frame)
    surface, notes = surface_of(material)
    assert surface.roughness == pytest.approx((0.1, 0.5))
    assert notes == ("Roughness is animated or driven, taken as 0.1 to 0.5",)
    data = tree.animation_data
    (curve,) = data.action.layers[0].strips[0].channelbag(data.action_slot).fcurves
    first, last = curve.keyframe_points
    first.handle_right_type = last.handle_left_type = "FREE"
    last.handle_left.y = 0.7
    assert surface_of(material)[0].roughness == pytest.approx((0.1, 0.7))
    first.interpolation = "LINEAR"
    assert surface_of(material)[0].roughness == pytest.approx((0.1, 0.5))
    first.interpolation = "ELASTIC"
    assert surface_of(material)[0].roughness == (0.0, 1.0)
    first.interpolation = "LINEAR"
    curve.extrapolation = "LINEAR"
    assert surface_of(material)[0].roughness == (0.0, 1.0)


def test_drivers_and_the_nla_can_give_anything(metal) -> None:
    material, tree, node = metal
    rough = node.inputs["Roughness"]
    rough.driver_add("default_value")
    surface, notes = surface_of(material)
    assert surface.roughness == (0.0, 1.0)
    assert notes == ("Roughness is animated or driven, taken as 0 to 1",)
    rough.driver_remove("default_value")
    rough.keyframe_insert("default_value", frame=1)
    assert surface_of(material)[1] == ()  # a lone key changes nothing
    data = tree.animation_data
    data.nla_tracks.new().strips.new("Strip", 1, data.action)
    data.action = None
    assert surface_of(material)[0].roughness == (0.0, 1.0)


def test_animation_is_followed_through_nodes(metal) -> None:
    """Of one component of a colour, of a Value node, and of a setting of a node."""
    material, tree, node = metal
    colour = node.inputs["Base Color"]
    colour.default_value = (0.2, 0.2, 0.2, 1.0)
    colour.keyframe_insert("default_value", index=0, frame=1)
    dark = surface_of(material)[0].colour
    colour.default_value[0] = 0.9
    colour.keyframe_insert("default_value", index=0, frame=9)
    colour.default_value[0] = 0.2
    lit, notes = surface_of(material)
    assert lit.colour[0] > dark[0]
    assert lit.colour[1:] == dark[1:]
    assert notes == ("Base Color is animated or driven, taken as 0.2 to 0.9",)
    tree.animation_data_clear()
    value = tree.nodes.new("ShaderNodeValue")
    for frame in (1, 2):
        value.outputs[0].default_value = 0.2 * frame
        value.outputs[0].keyframe_insert("default_value", frame=frame)
    assert linked_range(tree, node, value.outputs[0]) == pytest.approx((0.2, 0.4))
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    assert linked_range(tree, node, ramp.outputs[0]) != ANYTHING
    ramp.color_ramp.elements[1].keyframe_insert("color", frame=1)
    assert linked_range(tree, node, ramp.outputs[0]) == ANYTHING
