# SPDX-License-Identifier: GPL-3.0-or-later
"""Entry in the Shader editor's Add menu."""

import bpy

from ..ops.node import MICROBOUNCE_OT_add_conductor_node


def draw_add_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the entry at the end of the Add menu, for materials only."""
    if context.space_data.shader_type != "OBJECT":
        return
    menu.layout.separator()
    menu.layout.operator(MICROBOUNCE_OT_add_conductor_node.bl_idname, icon="MATERIAL")


def register() -> None:
    """Append the entry; the menu has this name in Blender 4.5 and 5.2 alike."""
    bpy.types.NODE_MT_shader_node_add_all.append(draw_add_menu)


def unregister() -> None:
    """Remove the entry."""
    bpy.types.NODE_MT_shader_node_add_all.remove(draw_add_menu)
