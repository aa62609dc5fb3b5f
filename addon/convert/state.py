# SPDX-License-Identifier: GPL-3.0-or-later
"""What a node holds, as plain data: it is translated, compared, and kept for the way back."""

from dataclasses import dataclass, field, replace

import bpy

from ..material.sockets import SocketValue, plain_value

# Properties of a node that are plain data; node groups also point at their tree.
_PLAIN = ("ENUM", "BOOLEAN", "INT", "FLOAT", "STRING")


@dataclass
class State:
    """A node's own data; its name, place and looks are not part of it.

    idname   -- its type, such as "ShaderNodeBsdfGlass"
    settings -- properties that only this type has, by identifier, and its width
    values   -- values of the inputs by name, also where a link hides them
    varying  -- names of inputs that are linked or animated: their values say nothing
    hidden   -- names of inputs that are hidden
    panels   -- whether its panels are collapsed, by their numbers (Blender 5.0 and later)
    """

    idname: str
    settings: dict[str, SocketValue] = field(default_factory=dict)
    values: dict[str, SocketValue] = field(default_factory=dict)
    varying: list[str] = field(default_factory=list)
    hidden: list[str] = field(default_factory=list)
    panels: dict[str, bool] = field(default_factory=dict)

    def holds_the_same(self, other: "State") -> bool:
        """Return whether both hold the same, whatever is linked or animated."""
        return replace(self, varying=[]) == replace(other, varying=[])

    def is_fixed(self, name: str, *values: SocketValue) -> bool:
        """Return whether input `name` is neither linked nor animated, and has one of `values`.

        An input that this Blender does not have counts as fixed.
        """
        if name not in self.values:
            return True
        return name not in self.varying and self.values[name] in values


def read_state(node: bpy.types.Node, animated: frozenset[str] = frozenset()) -> State:
    """Return what `node` holds; `animated` are the names of its inputs with curves or drivers."""
    return State(
        idname=node.bl_idname,
        settings={name: getattr(node, name) for name in _own_properties(node)},
        values={socket.name: plain_value(socket.default_value) for socket in node.inputs},
        varying=[s.name for s in node.inputs if s.is_linked or s.name in animated],
        hidden=[socket.name for socket in node.inputs if socket.hide],
        panels={str(p.identifier): p.is_collapsed for p in getattr(node, "panel_states", ())},
    )


def write_state(node: bpy.types.Node, state: State) -> None:
    """Give `node` what `state` holds, as far as this Blender's node has it."""
    own = _own_properties(node)
    for name, value in state.settings.items():
        if name in own:
            setattr(node, name, value)
    for socket in node.inputs:
        if socket.name in state.values:
            socket.default_value = state.values[socket.name]
        socket.hide = socket.name in state.hidden
    for panel in getattr(node, "panel_states", ()):
        panel.is_collapsed = state.panels.get(str(panel.identifier), panel.is_collapsed)


def inputs_by_name(node: bpy.types.Node) -> dict[str, bpy.types.NodeSocket]:
    """Return the inputs; Blender finds those of settings that are not chosen by number only."""
    return {socket.name: socket for socket in node.inputs}


def _own_properties(node: bpy.types.Node) -> list[str]:
    common = bpy.types.ShaderNode.bl_rna.properties
    found = ["width"]
    for prop in node.bl_rna.properties:
        if prop.identifier not in common and prop.type in _PLAIN and not prop.is_readonly:
            found.append(prop.identifier)
    return found
