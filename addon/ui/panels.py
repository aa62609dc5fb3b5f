# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels in the Shader editor's sidebar and in the material properties."""

import textwrap

import bpy

from ..core.kinds import KINDS
from ..operators.exact import missed_lights
from ..operators.material import MICROBOUNCE_OT_add_material
from ..operators.node import MICROBOUNCE_OT_add_node
from ..operators.osl import MICROBOUNCE_OT_enable_osl, osl_status
from ..text import label, message
from .choices import draw_choices

# Pixels at scale 1: the width of a character, rounded up, and of a line's margins.
_CHARACTER, _SIDES = 6.5, 72

# The class attributes that say where a panel is.
_PLACE = ("bl_space_type", "bl_region_type", "bl_category", "bl_context")


def draw_state(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say whether the shaders run. If OSL is merely off, offer to switch it on.

    If they run, name the lights that the material shown misses in quality Exact.
    """
    status = osl_status(context)
    if not status.ok:
        draw_text(layout, context, f"{message(status.reason)} {message(status.remedy)}")
        if status.can_enable:
            layout.operator(MICROBOUNCE_OT_enable_osl.bl_idname)
        return
    layout.label(text="Open Shading Language is on", icon="CHECKMARK")
    warning = missed_lights(context)
    if warning:
        draw_text(layout, context, warning, "ERROR")


def draw_buttons(layout: bpy.types.UILayout, operator: str) -> None:
    """Draw a button for each kind of material; `operator` is what adds it."""
    column = layout.column(align=True)
    for identifier, kind in KINDS.items():
        column.operator(
            operator, text=label("Add {name}", name=kind.name), icon="ADD"
        ).kind = identifier


def draw_text(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "INFO"
) -> None:
    """Draw `text`, already translated, in a box, wrapped to the region's width."""
    draw_lines(layout.box().column(align=True), context, text, icon)


def draw_lines(
    column: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str
) -> None:
    """Draw `text` as lines that fit the region, which labels do not do by themselves."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 without a window
    width = max(20, int((context.region.width / scale - _SIDES) / _CHARACTER))
    for number, line in enumerate(textwrap.wrap(text.replace(" %", "\u00a0%"), width)):
        column.label(text=line, icon="BLANK1" if number else icon)


class MICROBOUNCE_PT_shader_editor(bpy.types.Panel):
    """Microbounce in the Shader editor."""

    bl_label = "Microbounce"
    bl_space_type = "NODE_EDITOR"
    bl_region_type = "UI"
    bl_category = "Microbounce"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show it in the Shader editor only."""
        return context.space_data.tree_type == "ShaderNodeTree"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the state, the node's choices, and buttons for new nodes."""
        draw_state(self.layout, context)
        draw_choices(self.layout, context)
        draw_buttons(self.layout, MICROBOUNCE_OT_add_node.bl_idname)


class MICROBOUNCE_PT_material(bpy.types.Panel):
    """Microbounce in the material properties."""

    bl_label = "Microbounce"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show it in the material tab, for an object or a pinned material."""
        return context.object is not None or getattr(context, "material", None) is not None

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the state, the node's choices, and buttons for a new material."""
        draw_state(self.layout, context)
        draw_choices(self.layout, context)
        draw_buttons(self.layout, MICROBOUNCE_OT_add_material.bl_idname)


CLASSES = (MICROBOUNCE_PT_shader_editor, MICROBOUNCE_PT_material)


def in_both_editors(panel: type, in_shader_editor: str, in_material: str) -> tuple[type, type]:
    """Return `panel` as two registrable classes of these names, below the two panels above."""
    return tuple(
        type(
            name,
            (panel, bpy.types.Panel),
            {
                "__doc__": panel.__doc__,
                "bl_parent_id": parent.__name__,
                **{key: value for key, value in vars(parent).items() if key in _PLACE},
            },
        )
        for name, parent in zip((in_shader_editor, in_material), CLASSES, strict=True)
    )
