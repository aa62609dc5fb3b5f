# SPDX-License-Identifier: GPL-3.0-or-later
"""What the analysis reads from materials, and the shares of the picture that it finds."""

import math

import pytest

from addon.analysis.surfaces import found_nodes, read_choice, read_surface, why_fixed
from addon.core.intervals import ANYTHING, OPERATIONS, corners, mapped
from addon.core.kinds import KINDS
from addon.material.group import add_group_node, material_group
from addon.material.node import new_material

from ..support import surface_material
from .analysis_support import image, linked_range, textured

pytestmark = pytest.mark.usefixtures("compiled_once")


def math_node(tree, operation: str, source, *values: float, clamp: bool = False):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation, node.use_clamp = operation, clamp
    tree.links.new(source, node.inputs[0])
    for socket, value in zip(node.inputs[1:], values, strict=False):
        socket.default_value = value
    return node.outputs[0]


def test_plain_values(kind, empty_file) -> None:
    material = new_material(kind, "Plain", Roughness=0.6, Quality="Walk", MaxBounces=5, Walks=2)
    (found,) = found_nodes([material])
    surface, notes = read_surface(found)
    assert notes == ()
    assert surface.kind == kind
    assert surface.roughness == pytest.approx((0.6, 0.6))
    assert surface.alphas == pytest.approx((0.36, 0.36))
    assert (surface.walks, surface.models, surface.distributions) == (2, (0,), (0,))
    assert str(read_choice(found)) == "Walk, 5 bounces"
    assert why_fixed(found) == ""
    assert found.name == "Plain"


def test_an_image_gives_its_range(metal) -> None:
    _, tree, node = metal
    found = linked_range(tree, node, textured(tree, image(0.2, 0.7)))
    assert found == pytest.approx((0.2, 0.7), abs=1e-4)


def test_srgb_images_are_made_linear(metal) -> None:
    _, tree, node = metal
    found = linked_range(tree, node, textured(tree, image(0.0, 0.5, data=False)))
    assert found == pytest.approx((0.0, ((0.5 + 0.055) / 1.055) ** 2.4), abs=0.01)


def test_maths_and_maps(metal) -> None:
    _, tree, node = metal
    source = textured(tree, image(0.2, 0.6))
    half = math_node(tree, "MULTIPLY", source, 0.5)
    assert linked_range(tree, node, half) == pytest.approx((0.1, 0.3), abs=1e-4)
    inverse = math_node(tree, "SUBTRACT", source, 1.0, clamp=True)
    assert linked_range(tree, node, inverse) == pytest.approx((0.0, 0.0))
    spread = tree.nodes.new("ShaderNodeMapRange")
    tree.links.new(half, spread.inputs["Value"])
    spread.inputs["From Max"].default_value = 0.2
    spread.inputs["To Min"].default_value, spread.inputs["To Max"].default_value = 0.9, 0.5
    found = linked_range(tree, node, spread.outputs[0])
    assert found == pytest.approx((0.5, 0.7), abs=1e-4)
    invert = tree.nodes.new("ShaderNodeInvert")
    tree.links.new(source, invert.inputs["Color"])
    assert linked_range(tree, node, invert.outputs[0]) == pytest.approx((0.4, 0.8), abs=1e-4)
    gamma = tree.nodes.new("ShaderNodeGamma")
    tree.links.new(source, gamma.inputs["Color"])
    gamma.inputs["Gamma"].default_value = 2.0
    assert linked_range(tree, node, gamma.outputs[0]) == pytest.approx((0.04, 0.36), abs=1e-4)


def test_a_clamp_limits_what_is_unknown(metal) -> None:
    """No image, but a Map Range that clamps."""
    _, tree, node = metal
    noise = tree.nodes.new("ShaderNodeTexNoise")
    spread = tree.nodes.new("ShaderNodeMapRange")
    tree.links.new(noise.outputs[0], spread.inputs["Value"])
    spread.inputs["To Min"].default_value, spread.inputs["To Max"].default_value = 0.1, 0.2
    assert linked_range(tree, node, spread.outputs[0]) == pytest.approx((0.1, 0.2))
    assert linked_range(tree, node, noise.outputs[0]) == ANYTHING


def test_a_ramp_is_followed_between_its_ends(metal) -> None:
    _, tree, node = metal
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = (0.3, 0.3, 0.3, 1.0)
    ramp.color_ramp.elements[1].color = (0.5, 0.5, 0.5, 1.0)
    peak = ramp.color_ramp.elements.new(0.37)
    peak.color = (0.9, 0.9, 0.9, 1.0)
    tree.links.new(textured(tree, image(0.0, 1.0)), ramp.inputs[0])
    assert linked_range(tree, node, ramp.outputs[0]) == pytest.approx((0.3, 0.9), abs=1e-4)


@pytest.mark.parametrize("blend", ["MIX", "MULTIPLY", "ADD"])
def test_mixes_hold_all_that_blender_makes(metal, blend: str) -> None:
    _, tree, node = metal
    mix = tree.nodes.new("ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", blend
    by_identifier = {socket.identifier: socket for socket in mix.inputs}
    tree.links.new(textured(tree, image(0.1, 0.3)), by_identifier["A_Color"])
    by_identifier["B_Color"].default_value = (0.5, 0.5, 0.5, 1.0)
    by_identifier["Factor_Float"].default_value = 0.5
    output = next(socket for socket in mix.outputs if socket.identifier == "Result_Color")
    wanted = {"MIX": (0.3, 0.4), "MULTIPLY": (0.075, 0.225), "ADD": (0.35, 0.55)}[blend]
    assert linked_range(tree, node, output) == pytest.approx(wanted, abs=1e-4)


def test_reroutes_and_muted_nodes(metal) -> None:
    _, tree, node = metal
    value = tree.nodes.new("ShaderNodeValue")
    value.outputs[0].default_value = 0.35
    reroute = tree.nodes.new("NodeReroute")
    tree.links.new(value.outputs[0], reroute.inputs[0])
    halved = math_node(tree, "MULTIPLY", reroute.outputs[0], 0.5)
    assert linked_range(tree, node, halved) == pytest.approx((0.175, 0.175))
    halved.node.mute = True
    assert linked_range(tree, node, halved) == pytest.approx((0.35, 0.35))


def test_a_group_is_entered_and_left(metal) -> None:
    """Our node lies in a group whose roughness comes from outside, of two materials."""
    import bpy

    group = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    group.interface.new_socket("Rough", in_out="INPUT", socket_type="NodeSocketFloat")
    group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketShader")
    inputs, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    inner = add_group_node(group, material_group("CONDUCTOR"))
    group.links.new(inputs.outputs["Rough"], inner.inputs["Roughness"])
    group.links.new(inner.outputs["BSDF"], end.inputs["Out"])
    materials = []
    for number, rough in enumerate((0.2, 0.8)):
        material, tree, output = surface_material(f"User {number}")
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.inputs["Rough"].default_value = rough
        tree.links.new(node.outputs[0], output.inputs["Surface"])
        materials.append(material)
    (found,) = found_nodes(materials)
    assert found.materials == materials
    assert found.key[:2] == ("group", "Outer")
    surface, notes = read_surface(found)
    assert surface.roughness == pytest.approx((0.2, 0.8))
    assert notes == ()


def test_what_is_not_linked_is_not_found(metal) -> None:
    material, tree, node = metal
    assert len(found_nodes([material])) == 1
    tree.links.remove(node.outputs["BSDF"].links[0])
    assert found_nodes([material]) == []


def test_muted_and_foreign_materials_are_not_found(metal) -> None:
    import bpy

    material, _, node = metal
    node.mute = True
    bare, _, _ = surface_material("Bare")
    assert found_nodes([material, bare, bpy.data.materials.new("Plain")]) == []


def test_two_nodes_of_one_material_are_told_apart(metal) -> None:
    material, tree, node = metal
    other = add_group_node(tree, material_group("DIFFUSE"))
    other.name = "Dirt"
    mix = tree.nodes.new("ShaderNodeMixShader")
    output = tree.get_output_node("CYCLES")
    tree.links.new(node.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    names = sorted(found.name for found in found_nodes([material]))
    assert names == ["Metal", "Metal: Dirt"]


@pytest.mark.parametrize("label", ["Quality", "Max Bounces"])
def test_drivers_keys_and_links_are_left_alone(metal, label: str) -> None:
    material, tree, node = metal
    socket = node.inputs[label]
    socket.driver_add("default_value")
    assert why_fixed(found_nodes([material])[0]) == f"{label} has a driver or is animated"
    socket.driver_remove("default_value")
    socket.keyframe_insert("default_value", frame=1)
    assert why_fixed(found_nodes([material])[0]) == f"{label} has a driver or is animated"
    tree.animation_data_clear()
    value = tree.nodes.new("ShaderNodeValue")
    tree.links.new(value.outputs[0], socket)
    assert why_fixed(found_nodes([material])[0]) == f"{label} is linked"


def test_bounce_only_is_left_alone(empty_file) -> None:
    material = new_material("DIFFUSE", "Study", BounceOnly=2)
    assert why_fixed(found_nodes([material])[0]) == "Bounce Only shows one bounce, for study"


def test_metals_by_index_have_its_reflectance(empty_file) -> None:
    values = {"Fresnel": 1, "IOR": (0.2, 0.92, 1.1), "Extinction": (3.91, 2.45, 2.14)}
    surface, _ = read_surface(found_nodes([new_material("CONDUCTOR", "Copper", **values)])[0])
    assert surface.colour[0] > 0.93
    assert surface.colour[2] < 0.6


def test_intervals() -> None:
    assert OPERATIONS["DIVIDE"]((1.0, 2.0), (-1.0, 1.0), None) == ANYTHING
    assert OPERATIONS["DIVIDE"]((1.0, 2.0), (2.0, 4.0), None) == (0.25, 1.0)
    assert OPERATIONS["POWER"]((-1.0, 2.0), (2.0, 2.0), None) == ANYTHING
    assert OPERATIONS["ABSOLUTE"]((-3.0, 2.0), None, None) == (0.0, 3.0)
    assert OPERATIONS["MULTIPLY"](ANYTHING, (0.0, 0.0), None) == (0.0, 0.0)
    assert corners(math.sqrt, (-1.0, 4.0)) == ANYTHING
    assert mapped((0.0, 1.0), (1.0, 1.0), (0.3, 0.6), clamp=True) == (0.3, 0.3)


def test_every_kind_is_read_from_the_file(empty_file) -> None:
    materials = [new_material(kind, kind) for kind in KINDS]
    assert {found.kind.identifier for found in found_nodes(materials)} == set(KINDS)
