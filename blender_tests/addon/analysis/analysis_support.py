# SPDX-License-Identifier: GPL-3.0-or-later
"""Textured inputs, and what the analysis reads of them."""

import bpy

from addon.analysis.surfaces import found_nodes, read_surface
from addon.core.analysis.prediction import Surface
from addon.core.intervals import Interval
from addon.scene.ranges import input_range
from addon.scene.sources import Sources


def surface_of(material: bpy.types.Material) -> tuple[Surface, tuple[str, ...]]:
    """Return what is read of a material's only node, and the notes."""
    (found,) = found_nodes([material])
    return read_surface(found)


def image(low: float, high: float, name: str = "Slope", data: bool = True) -> bpy.types.Image:
    """Return a small image whose values go from `low` to `high`, by default as data."""
    made = bpy.data.images.new(name, 8, 8, float_buffer=data, is_data=data)
    values = [low + (high - low) * i / 63 for i in range(64)]
    made.pixels = [part for v in values for part in (v, v, v, 1.0)]
    return made


def textured(tree: bpy.types.NodeTree, made: bpy.types.Image) -> bpy.types.NodeSocket:
    """Return the colour of a new texture node."""
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = made
    return node.outputs["Color"]


def linked_range(
    tree: bpy.types.NodeTree, node: bpy.types.Node, source: bpy.types.NodeSocket
) -> Interval:
    """Link `source` to the node's Roughness and return the range of that."""
    tree.links.new(source, node.inputs["Roughness"])
    return input_range(node.inputs["Roughness"], (), Sources())[0]
