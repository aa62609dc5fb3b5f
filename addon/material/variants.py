# SPDX-License-Identifier: GPL-3.0-or-later
"""Switches a node of one of our groups between its own values and Cycles' own closure.

It changes the node tree that the node is in: work on a copy of the user's file.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ..core.kinds import Kind, kind_named
from .fallback import MATTE_ROUGHNESS
from .graph import node_kind
from .sockets import socket_value

_NATIVE = {
    "CONDUCTOR": "ShaderNodeBsdfMetallic",
    "DIELECTRIC": "ShaderNodeBsdfGlass",
    "DIFFUSE": "ShaderNodeBsdfDiffuse",
}
# The parameters that a native node shares. A metal's `fresnel_type` shows two more.
_SHARED = {
    "CONDUCTOR": ("Roughness", "Anisotropy", "Rotation", "Normal", "Tangent"),
    "DIELECTRIC": ("Color", "IOR", "Roughness", "Normal"),
    "DIFFUSE": ("Color", "Normal"),
}
_METAL_COLOR = {"F82": ("BaseColor", "EdgeTint"), "PHYSICAL_CONDUCTOR": ("IOR", "Extinction")}


@dataclass(frozen=True)
class Placed:
    """A node of one of our groups, by its name in the node tree that it is in."""

    tree: bpy.types.NodeTree
    name: str

    @property
    def node(self) -> bpy.types.ShaderNodeGroup:
        """The node, looked up again because adding nodes may move it in memory."""
        return self.tree.nodes[self.name]

    @property
    def kind(self) -> Kind:
        """What it is made of."""
        return kind_named(node_kind(self.node))

    def get(self, identifier: str) -> object:
        """Return a parameter's unlinked value: a number, or a list of three or four."""
        value = self._socket(identifier).default_value
        return list(value) if hasattr(value, "__len__") else value

    def set(self, identifier: str, value: object) -> None:
        """Set a parameter, cutting its link; raises what Parameter.checked() raises."""
        checked = socket_value(self.kind.by_identifier[identifier], value)
        socket = self._socket(identifier)
        for link in socket.links:
            self.tree.links.remove(link)
        socket.default_value = checked

    def show_ours(self) -> None:
        """Put our node in the place of Cycles' own."""
        native = self.tree.nodes.get(self._native_name)
        if native is not None:
            self._move_links(native, self.node)

    def show_cycles(self) -> None:
        """Put Cycles' own closure of the same values in the place of our node.

        GGX becomes Multiscatter GGX. For Beckmann, Cycles has only one bounce. Cycles' glass and
        matte surface have no anisotropy, and the matte surface takes a part of the roughness.
        """
        native = self._native_node()
        kind = self.kind.identifier
        shared = _SHARED[kind]
        if kind == "CONDUCTOR":
            native.fresnel_type = "PHYSICAL_CONDUCTOR" if self.get("Fresnel") else "F82"
            shared += _METAL_COLOR[native.fresnel_type]
        if kind == "DIFFUSE":
            self._take_part_of_roughness(native)
        else:
            native.distribution = "BECKMANN" if self.get("Distribution") else "MULTI_GGX"
        for identifier in shared:
            source = self._socket(identifier)
            target = native.inputs[source.name]
            if source.is_linked:
                self.tree.links.new(source.links[0].from_socket, target)
            else:
                target.default_value = source.default_value
        self._move_links(self.node, native)

    @property
    def _native_name(self) -> str:
        return f"Cycles' Own for {self.name}"

    def _socket(self, identifier: str) -> bpy.types.NodeSocket:
        return self.node.inputs[self.kind.by_identifier[identifier].label]

    def _native_node(self) -> bpy.types.Node:
        native = self.tree.nodes.get(self._native_name)
        if native is None:
            native = self.tree.nodes.new(_NATIVE[self.kind.identifier])
            native.name = native.label = self._native_name
            native.location = (0, -500)
        return native

    def _take_part_of_roughness(self, native: bpy.types.Node) -> None:
        source, target = self._socket("Roughness"), native.inputs["Roughness"]
        if not source.is_linked:
            target.default_value = MATTE_ROUGHNESS * source.default_value
        elif not target.is_linked:
            part = self.tree.nodes.new("ShaderNodeMath")
            part.operation = "MULTIPLY"
            part.inputs[1].default_value = MATTE_ROUGHNESS
            self.tree.links.new(source.links[0].from_socket, part.inputs[0])
            self.tree.links.new(part.outputs[0], target)

    def _move_links(self, source: bpy.types.Node, target: bpy.types.Node) -> None:
        for socket in [link.to_socket for link in source.outputs[0].links]:
            self.tree.links.new(target.outputs[0], socket)


def placed_in(trees: list[bpy.types.NodeTree]) -> Iterator[Placed]:
    """Yield every node of ours that lies in one of `trees`, not in what they contain."""
    for tree in trees:
        for name in [node.name for node in tree.nodes if node_kind(node)]:
            yield Placed(tree, name)
