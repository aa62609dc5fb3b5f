# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials switch between Microbounce and Cycles' own closure, as in the demo."""

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
    metals = variants.find_materials()
    for number, quality in enumerate(("Single", "Fitted", "Walk", "Exact")):
        variants.use_quality(metals, quality)
        assert [metal.get("Quality") for metal in metals] == [number] * len(metals)
        assert all(surface_source(metal) == metal.node for metal in metals)


def test_cycles_metal_takes_the_groups_values():
    opened("showcase")
    metals = variants.find_materials()
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


@pytest.mark.parametrize(
    ("kind", "native_type", "roughness"),
    [("DIELECTRIC", "ShaderNodeBsdfGlass", 0.6), ("DIFFUSE", "ShaderNodeBsdfDiffuse", 0.25 * 0.6)],
)
def test_other_kinds_have_their_own_node_of_cycles(kind, native_type, roughness):
    opened(f"furnace_{kind.lower()}")
    (material,) = variants.find_materials()
    assert material.kind.identifier == kind
    material.set("Color", (0.9, 0.5, 0.25))
    material.set("Roughness", 0.6)
    if kind == "DIELECTRIC":
        material.set("IOR", 1.3)
        material.set("Distribution", "Beckmann")
    variants.use_cycles_multiscatter([material])
    native = surface_source(material)
    assert native.bl_idname == native_type
    assert list(native.inputs["Color"].default_value) == pytest.approx([0.9, 0.5, 0.25, 1.0])
    assert native.inputs["Roughness"].default_value == pytest.approx(roughness)
    if kind == "DIELECTRIC":
        assert native.inputs["IOR"].default_value == pytest.approx(1.3)
        assert native.distribution == "BECKMANN"
    variants.use_quality([material], "Exact")
    assert surface_source(material) == material.node


def test_file_without_our_materials_is_refused():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with pytest.raises(RuntimeError, match="make scenes"):
        variants.find_materials()
