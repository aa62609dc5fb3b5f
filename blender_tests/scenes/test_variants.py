# SPDX-License-Identifier: GPL-3.0-or-later
"""Switching the metals between Microbounce and Cycles' own closure, as the demo does."""

import bpy
import pytest

from blender_tests.scenes.test_blend_files import opened
from scenes import variants


def surface_source(metal):
    """Return the node that the material's output shows."""
    output = metal.material.node_tree.get_output_node("CYCLES")
    return output.inputs["Surface"].links[0].from_node


def test_quality_is_set_on_every_metal():
    opened("showcase")
    metals = variants.find_metals()
    for number, quality in enumerate(("Single", "Fitted", "Walk", "Exact")):
        variants.use_quality(metals, quality)
        assert [metal.get("Quality") for metal in metals] == [number] * len(metals)
        assert all(surface_source(metal) == metal.node for metal in metals)


def test_cycles_metal_takes_the_groups_values():
    opened("showcase")
    metals = variants.find_metals()
    for _ in range(2):  # the second time it finds its nodes again
        variants.use_cycles_multiscatter(metals)
    for metal in metals:
        native = surface_source(metal)
        assert native.bl_idname == "ShaderNodeBsdfMetallic"
        assert native.distribution == ("BECKMANN" if metal.get("Distribution") else "MULTI_GGX")
        for name in ("Roughness", "Anisotropy", "Rotation"):
            assert native.inputs[name].default_value == metal.get(name)
        kind = "ShaderNodeBsdfMetallic"
        assert sum(node.bl_idname == kind for node in metal.material.node_tree.nodes) == 1
    variants.use_quality(metals, "Walk")
    assert all(surface_source(metal) == metal.node for metal in metals)


def test_file_without_metals_is_refused():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with pytest.raises(RuntimeError, match="make scenes"):
        variants.find_metals()
