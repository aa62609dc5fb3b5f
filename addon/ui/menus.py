# SPDX-License-Identifier: GPL-3.0-or-later
"""The Shader editor's menu Add > Microbounce."""

import bpy

from ..core.kinds import KINDS
from ..operators.node import MICROBOUNCE_OT_add_node


class MICROBOUNCE_MT_add(bpy.types.Menu):
    """The kinds of material, to be added as nodes."""

    bl_label = "Microbounce"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw an entry for each kind."""
        for identifier, kind in KINDS.items():
            entry = self.layout.operator(MICROBOUNCE_OT_add_node.bl_idname, text=kind.name)
            entry.kind = identifier


CLASSES = (MICROBOUNCE_MT_add,)


def draw_add_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the menu at the end of the Add menu, for materials only."""
    if context.space_data.shader_type != "OBJECT":
        return
    menu.layout.separator()
    menu.layout.menu(MICROBOUNCE_MT_add.__name__, icon="MATERIAL")


def register() -> None:
    """Append the menu; the one it goes into has this name in Blender 4.5 and 5.2 alike."""
    bpy.types.NODE_MT_shader_node_add_all.append(draw_add_menu)


def unregister() -> None:
    """Remove it."""
    bpy.types.NODE_MT_shader_node_add_all.remove(draw_add_menu)
