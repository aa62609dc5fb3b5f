# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens the scenes of the plan and switches them from variant to variant."""

from collections.abc import Callable

import bpy
import numpy as np

from addon.material.group import material_group
from scenes import bench_mesh, pictures, variants

from .plan import EXACT, NATIVE, Scene, Variant
from .shaders import patched_group


def open_stage(scene: Scene) -> list[variants.Material]:
    """Open `scene` with its values in place of the current file; return its materials."""
    materials = _OPEN[scene.stage](scene)
    for material in materials:
        for identifier, value in scene.values:
            material.set(identifier, value)
    render = bpy.context.scene.render
    render.resolution_percentage = scene.percentage
    # Keeps meshes and shaders between renders, so times are those of the samples.
    render.use_persistent_data = True
    cycles = bpy.context.scene.cycles
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    return materials


def switch_to(scene: Scene, variant: Variant, materials: list[variants.Material]) -> None:
    """Show the variant, with no setting left from the one before."""
    blender = bpy.context.scene
    blender.cycles.shading_system = variant.osl
    blender.render.resolution_percentage = variant.percentage or scene.percentage
    for material in materials:
        kind = material.kind.identifier
        group = patched_group(kind, variant.patch) if variant.patch else material_group(kind)
        _use_group(material, group)
        for identifier, parameter in material.kind.by_identifier.items():
            if identifier in _SWITCHED:
                material.set(identifier, parameter.default)
    for identifier, value in (*scene.values, *variant.values):
        for material in materials:
            material.set(identifier, value)
    if variant.quality == NATIVE:
        variants.use_cycles_multiscatter(materials)
    else:
        variants.use_quality(materials, variant.quality)


def reference_variant() -> Variant:
    """The variant that renders the reference of a scene without one from the oracle."""
    return Variant("reference", EXACT)


def picture_mask(passes: dict) -> np.ndarray:
    """The pixels that show a material of ours, by the objects' index."""
    return np.rint(passes["IndexOB.X"]) > 0


# The parameters that variants set besides Quality.
_SWITCHED = ("Model", "MaxBounces", "Walks")


def _use_group(material: variants.Material, group: bpy.types.ShaderNodeTree) -> None:
    """Exchange the group but keep the values. Both groups have the same sockets."""
    node = material.node
    if node.node_tree != group:
        kept = {
            socket.name: socket.default_value
            if not hasattr(socket.default_value, "__len__")
            else tuple(socket.default_value)
            for socket in node.inputs
        }
        node.node_tree = group
        for socket in node.inputs:
            socket.default_value = kept[socket.name]


def _lit(scene: Scene) -> list[variants.Material]:
    return [pictures.open_lit(scene.stage, scene.kind)]


def _furnace(scene: Scene) -> list[variants.Material]:
    return [pictures.open_scene(f"furnace_{scene.kind.lower()}")]


def _showcase(scene: Scene) -> list[variants.Material]:
    pictures.open_scene("showcase")
    return variants.find_materials()


def _mesh(scene: Scene) -> list[variants.Material]:
    bench_mesh.build()
    return variants.find_materials()


_OPEN: dict[str, Callable[[Scene], list[variants.Material]]] = {
    "slab": _lit,
    "sun": _lit,
    "back": _lit,
    "furnace": _furnace,
    "showcase": _showcase,
    "mesh": _mesh,
}
