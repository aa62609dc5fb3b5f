# SPDX-License-Identifier: GPL-3.0-or-later
"""Menus with the names of what the node's sockets show as numbers, such as Quality.

Blender 4.5 has no menu sockets that a shader could read.
"""

import bpy

from ..core.kinds import KINDS
from ..core.parameter import Parameter
from ..material.graph import node_kind
from ..material.node import material_node
from ..operators.choices import MICROBOUNCE_OT_set_choice
from ..operators.presets import shown_material
from ..text import label

_CHOICES = {
    parameter.identifier: parameter
    for kind in KINDS.values()
    for parameter in kind.parameters
    if parameter.choices
}


def draw_choices(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw a menu, with the present value as its title, for each choice of the material's node."""
    node = material_node(shown_material(context))
    if node is None:
        return
    column = layout.column(align=True)
    for parameter in KINDS[node_kind(node)].parameters:
        socket = node.inputs.get(parameter.label)  # None in groups of some other versions
        if not parameter.choices or socket is None:
            continue
        row = column.split(factor=0.4)
        row.label(text=parameter.label)
        if socket.is_linked:
            row.label(text=label("Linked"), icon="LINKED")
        else:
            row.menu(_menu_name(parameter), text=_shown_value(parameter, socket.default_value))


class _ChoiceMenu:
    """The values of a parameter, to set one on the material's node."""

    parameter: Parameter

    def draw(self, context: bpy.types.Context) -> None:
        """Draw an entry for each value."""
        for name in self.parameter.choices:
            entry = self.layout.operator(MICROBOUNCE_OT_set_choice.bl_idname, text=name)
            entry.parameter, entry.value = self.parameter.identifier, name


def _menu_name(parameter: Parameter) -> str:
    return f"MICROBOUNCE_MT_{parameter.identifier.lower()}"


def _menu(parameter: Parameter) -> type:
    members = {
        "__doc__": f"The values of {parameter.label}.",
        "bl_label": parameter.label,
        "bl_description": parameter.tooltip,
        "parameter": parameter,
    }
    return type(_menu_name(parameter), (_ChoiceMenu, bpy.types.Menu), members)


def _shown_value(parameter: Parameter, number: int) -> str:
    """Return the name of a value; a number that has none is one of another version."""
    names = dict(enumerate(parameter.choices))
    return names.get(number, str(number))


CLASSES = tuple(_menu(parameter) for parameter in _CHOICES.values())
