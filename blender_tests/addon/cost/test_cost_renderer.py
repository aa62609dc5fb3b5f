# SPDX-License-Identifier: GPL-3.0-or-later
"""Switching the materials from variant to variant leaves nothing of the one before."""

import bpy
import pytest

from addon.core.cost.plan import Options, planned_variants, reference_variant
from addon.cost.renderer import Renderer, placed_nodes
from blender_tests.addon.cost.cost_support import tiny_scene

VARIANTS = {v.key: v for v in planned_variants(Options(kernels=(0.2,)))}


@pytest.fixture
def renderer(registered, compiled_once, tmp_path):
    """The scene's renderer; the material's Max Bounces is linked to a node."""
    scene = tiny_scene()
    tree = bpy.data.materials["Ours"].node_tree
    value = tree.nodes.new("ShaderNodeValue")
    placed = placed_nodes()[0]
    tree.links.new(value.outputs[0], placed.node.inputs[_label("MaxBounces")])
    return Renderer(scene, "ViewLayer", Options(), tmp_path)


def _label(identifier):
    return placed_nodes()[0].kind.by_identifier[identifier].label


def _state():
    """Return the values of our node, what its sockets are linked to, and what it is linked to."""
    node = placed_nodes()[0].node
    values = {s.name: repr(getattr(s, "default_value", None)) for s in node.inputs}
    links = {s.name: s.links[0].from_node.name for s in node.inputs if s.is_linked}
    return values, links, [link.to_node.name for link in node.outputs[0].links]


def _surface():
    output = bpy.data.materials["Ours"].node_tree.get_output_node("CYCLES")
    return output.inputs["Surface"].links[0].from_node


def test_steps_override_only_their_own(renderer):
    renderer.show(VARIANTS["fitted"])
    fitted = _state()
    assert _label("MaxBounces") in fitted[1]
    for key in ("bounces_4", "cycles_svm", "kernel_0.2", "cycles_osl"):
        renderer.show(VARIANTS[key])
        assert _state() != fitted, key
    renderer.show(reference_variant("WALK"))
    renderer.show(VARIANTS["fitted"])
    assert _state() == fitted


def test_bounces_cut_the_link_while_they_are_shown(renderer):
    renderer.show(VARIANTS["bounces_4"])
    values, links, _ = _state()
    assert values[_label("MaxBounces")] == "4"
    assert _label("MaxBounces") not in links


def test_cycles_own_takes_the_place_of_ours(renderer):
    renderer.show(VARIANTS["cycles_svm"])
    assert _surface().bl_idname == "ShaderNodeBsdfMetallic"
    assert bpy.context.scene.cycles.shading_system is False
    renderer.show(VARIANTS["cycles_osl"])
    assert _surface().bl_idname == "ShaderNodeBsdfMetallic"
    assert bpy.context.scene.cycles.shading_system is True
    renderer.show(VARIANTS["walk"])
    assert _surface().bl_idname == "ShaderNodeGroup"


def test_the_scene_is_rendered_without_what_biases_pixels(renderer):
    scene = bpy.context.scene
    cycles = scene.cycles
    assert not (cycles.use_denoising)
    assert not (cycles.use_adaptive_sampling)
    assert not (cycles.use_animated_seed)
    assert not (scene.render.use_compositing)
    assert not (scene.render.use_sequencer)
    assert scene.render.resolution_percentage == 50
    assert cycles.sample_clamp_indirect == 10.0, "clamping is the user's"
