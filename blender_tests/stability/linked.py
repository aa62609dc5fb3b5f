# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials whose parameters come from attributes, so that one picture, and one compiled shader,
shows many sets of parameters; nothing is folded then when the render starts."""

from collections.abc import Sequence

import bpy
import numpy as np

from addon.core.kinds import kind_named
from addon.material.node import new_material


def linked_material(
    kind: str, name: str, parameters: Sequence[str], source: str = "GEOMETRY", **values: object
) -> bpy.types.Material:
    """A material whose `parameters`, by identifier, are attributes of that name of the mesh
    (`source` GEOMETRY) or properties of the object (OBJECT); the others have `values`."""
    material = new_material(kind, name, **values)
    tree = material.node_tree
    node = group_node(material)
    known = kind_named(kind).by_identifier
    for identifier in parameters:
        attribute = tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = identifier
        attribute.attribute_type = source
        output = "Vector" if known[identifier].is_vector else "Fac"
        tree.links.new(attribute.outputs[output], node.inputs[known[identifier].label])
    return material


def group_node(material: bpy.types.Material) -> bpy.types.ShaderNodeGroup:
    """The node of our group in a material of ours."""
    nodes = material.node_tree.nodes
    return next(node for node in nodes if node.bl_idname == "ShaderNodeGroup")


def set_attribute(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    """Give each face of the mesh a number, `values` (n,)."""
    attribute = mesh.attributes.new(name, "FLOAT", "FACE")
    attribute.data.foreach_set("value", np.asarray(values, dtype=np.float32))
