# SPDX-License-Identifier: GPL-3.0-or-later
"""What happens to a ray from the camera at a material: it ends, passes, or is mirrored.

Every material counts, ours and Blender's own. In doubt the ray passes, so shares of the picture
come out too large rather than too small.
"""

from enum import Enum

import bpy

from ..material.graph import Path, node_kind, reached_nodes, surface_tree
from .ranges import input_range
from .sources import Sources

# Below this roughness a reflection is a sharp picture.
_MIRROR_ROUGHNESS = 0.25

_CLEAR = {"ShaderNodeBsdfGlass", "ShaderNodeBsdfRefraction", "ShaderNodeBsdfTransparent"}
_GLOSSY = {"ShaderNodeBsdfGlossy", "ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfMetallic"}


class Passage(Enum):
    """What a ray does at a surface."""

    ENDS = "ends"
    THROUGH = "through"
    MIRRORED = "mirrored"


def passage(material: bpy.types.Material, sources: Sources) -> Passage:
    """Return what a ray from the camera does at this material."""
    tree = surface_tree(material)
    output = tree.get_output_node("CYCLES") if tree is not None else None
    linked = [name for name in ("Surface", "Volume") if output and output.inputs[name].is_linked]
    if linked == ["Volume"]:
        return Passage.THROUGH
    found = {_of_node(node, path, sources) for path, node in reached_nodes(tree) if not node.mute}
    # If it does both, the light from behind counts more.
    ways = (Passage.THROUGH, Passage.MIRRORED)
    return next((way for way in ways if way in found), Passage.ENDS)


def _of_node(node: bpy.types.Node, path: Path, sources: Sources) -> Passage:
    def ends(name: str) -> tuple[float, float]:
        return input_range(node.inputs[name], path, sources)[0]

    name = node.bl_idname
    kind = node_kind(node)
    metal = name in _GLOSSY or kind == "CONDUCTOR"
    if name in _CLEAR or kind == "DIELECTRIC":
        return Passage.THROUGH
    if name == "ShaderNodeBsdfPrincipled":
        if ends("Transmission Weight")[1] > 0.0 or ends("Alpha")[0] < 1.0:
            return Passage.THROUGH
        metal = ends("Metallic")[1] >= 0.5
    if metal and ends("Roughness")[0] < _MIRROR_ROUGHNESS:
        return Passage.MIRRORED
    return Passage.ENDS
