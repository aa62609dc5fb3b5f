# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials with textures and links around one node, and node trees as plain data."""

import bpy

from blender_tests.addon.support import surface_material

METALLIC = "ShaderNodeBsdfMetallic"
GLOSSY = "ShaderNodeBsdfAnisotropic"
GLASS = "ShaderNodeBsdfGlass"
DIFFUSE = "ShaderNodeBsdfDiffuse"
PRINCIPLED = "ShaderNodeBsdfPrincipled"

_PLAIN = ("INT", "FLOAT", "ENUM", "BOOLEAN", "STRING")


def material_with(idname: str, **values: object) -> tuple[bpy.types.Material, bpy.types.Node]:
    """Return a material of one node of type `idname` and an output, and that node.

    `values` are inputs by name, with _ for a space, and the properties distribution and
    fresnel_type.
    """
    material, tree, output = surface_material(idname)
    node = tree.nodes.new(idname)
    for name, value in values.items():
        if name in ("distribution", "fresnel_type"):
            setattr(node, name, value)
        else:
            node.inputs[name.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material, node


def dress(material: bpy.types.Material, node: bpy.types.Node, *linked: str) -> None:
    """Give `node` a frame, a label, a place, a colour, a custom property, and linked inputs."""
    tree = material.node_tree
    frame = tree.nodes.new("NodeFrame")
    frame.location = (-50, 80)
    node.parent = frame
    node.location = (120, -40)
    node.label, node.use_custom_color, node.color = "Mine", True, (0.2, 0.4, 0.6)
    node.width, node.mute, node.select = 321, True, False
    node["note"] = "keep me"
    tree.nodes.active = node
    for name in linked:
        if name in ("Normal", "Tangent"):
            source = tree.nodes.new(
                "ShaderNodeNormalMap" if name == "Normal" else "ShaderNodeTangent"
            )
        else:
            source = tree.nodes.new("ShaderNodeTexNoise")
        source.name = f"To {name}"
        tree.links.new(source.outputs[0], node.inputs[name])
    # A second user of the closure, behind a link that is muted.
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(node.outputs[0], mix.inputs[1]).is_muted = True


def dump(tree: bpy.types.NodeTree) -> dict:
    """Return all of a node tree that a user can see or set, as data that can be compared."""
    nodes = {node.name: _dump_node(node) for node in tree.nodes}
    links = sorted(
        (
            *(link.from_node.name, link.from_socket.identifier),
            *(link.to_node.name, link.to_socket.identifier, link.is_muted),
        )
        for link in tree.links
    )
    active = tree.nodes.active.name if tree.nodes.active else ""
    return {"nodes": nodes, "links": links, "active": active, "curves": curve_paths(tree)}


def curve_paths(tree: bpy.types.NodeTree) -> list[str]:
    """Return what the tree's F-curves and drivers move."""
    data = tree.animation_data
    if data is None:
        return []
    paths = [driver.data_path for driver in data.drivers]
    if data.action is not None:
        for layer in data.action.layers:
            for strip in layer.strips:
                paths += [c.data_path for bag in strip.channelbags for c in bag.fcurves]
    return sorted(paths)


def _dump_node(node: bpy.types.Node) -> dict:
    properties = {
        prop.identifier: _value(getattr(node, prop.identifier))
        for prop in node.bl_rna.properties
        if prop.type in _PLAIN
    }
    sockets = [
        (s.identifier, s.hide, s.enabled, _value(getattr(s, "default_value", None)))
        for s in node.inputs
    ]
    panels = [(p.identifier, p.is_collapsed) for p in getattr(node, "panel_states", ())]
    return {
        "properties": properties,
        "sockets": sockets,
        "panels": panels,
        "parent": node.parent.name if node.parent else "",
        "group": node.node_tree.name if node.bl_idname == "ShaderNodeGroup" else "",
        "custom": dict(node.items()),
    }


def _value(value: object) -> object:
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value
