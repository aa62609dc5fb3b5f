# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels with the presets: search, pictures, finishes, the user's own, and the source of values."""

import bpy

from ..core.kinds import KINDS
from ..core.presets.catalogue import finishes, preset, presets, problems
from ..core.presets.files import PresetError
from ..material.graph import node_kind
from ..material.node import material_node
from ..operators.kinds import KIND_ITEMS
from ..operators.library import (
    MICROBOUNCE_OT_register_library,
    MICROBOUNCE_OT_unregister_library,
    registered_libraries,
)
from ..operators.presets import (
    MICROBOUNCE_OT_apply_finish,
    MICROBOUNCE_OT_apply_preset,
    MICROBOUNCE_OT_search_preset,
    shown_material,
)
from ..operators.user_presets import (
    MICROBOUNCE_OT_apply_user_preset,
    MICROBOUNCE_OT_remove_user_preset,
    MICROBOUNCE_OT_save_preset,
    shown_name,
)
from ..presets import icons as preset_icons
from ..presets.apply import PRESET_KEY
from ..presets.user import user_presets
from .panels import draw_lines, draw_text

# Choices of the window manager, so that no file stores them: which pictures there are, and whether
# they are folded out.
SHOWN, OPEN = "microbounce_presets_shown", "microbounce_presets_open"
_PICTURE_SCALE = 3.6  # in units of the interface's line height


class MICROBOUNCE_MT_finishes(bpy.types.Menu):
    """The finishes for the material's node."""

    bl_label = "Finish"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw an entry for each finish that the node's kind can have."""
        node = material_node(shown_material(context))
        for finish in finishes(node_kind(node) if node is not None else None):
            entry = self.layout.operator(MICROBOUNCE_OT_apply_finish.bl_idname, text=finish.name)
            entry.identifier = finish.identifier


class MICROBOUNCE_MT_user_presets(bpy.types.Menu):
    """The presets that the user saved."""

    bl_label = "My Presets"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the presets by kind, each with a button that removes it, and a way to save one."""
        layout = self.layout
        for kind in KINDS:
            paths = user_presets(kind)
            if not paths:
                continue
            layout.label(text=KINDS[kind].label)
            for path in paths:
                row = layout.row(align=True)
                name = shown_name(path)
                apply = row.operator(MICROBOUNCE_OT_apply_user_preset.bl_idname, text=name)
                apply.filepath = str(path)
                remove = row.operator(
                    MICROBOUNCE_OT_remove_user_preset.bl_idname, text="", icon="REMOVE"
                )
                remove.filepath = str(path)
            layout.separator()
        layout.operator(MICROBOUNCE_OT_save_preset.bl_idname, text="Save Preset", icon="ADD")


def draw_presets(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw search, menus, the source of the node's values, and the pictures of the presets."""
    node = material_node(shown_material(context))
    layout.operator(MICROBOUNCE_OT_search_preset.bl_idname, text="Search Presets", icon="VIEWZOOM")
    row = layout.row(align=True)
    row.menu(MICROBOUNCE_MT_finishes.__name__)
    row.menu(MICROBOUNCE_MT_user_presets.__name__)
    if node is not None:
        _draw_source(layout, context, node)
    for problem in problems():
        draw_text(layout, context, problem, "ERROR")
    _draw_library(layout, context)
    header, body = layout.panel_prop(context.window_manager, OPEN)
    header.label(text="Pictures")
    if body is not None:
        _draw_pictures(body, context, node)


def _draw_pictures(
    layout: bpy.types.UILayout, context: bpy.types.Context, node: bpy.types.Node | None
) -> None:
    """Draw a picture and a button for each of the presets shown."""
    layout.prop(context.window_manager, SHOWN, text="Show")
    grid = layout.grid_flow(row_major=True, even_columns=True, even_rows=True)
    for item in presets(_shown_kind(context, node)):
        cell = grid.column(align=True)
        cell.template_icon(icon_value=preset_icons.icon(item.identifier), scale=_PICTURE_SCALE)
        button = cell.operator(MICROBOUNCE_OT_apply_preset.bl_idname, text=item.name)
        button.identifier = item.identifier


def _shown_kind(context: bpy.types.Context, node: bpy.types.Node | None) -> str | None:
    """Return the kind whose presets are shown, None for all of them."""
    choice = getattr(context.window_manager, SHOWN)
    if choice == "MATERIAL" and node is not None:
        return node_kind(node)
    return choice if choice in KINDS else None


def _draw_source(
    layout: bpy.types.UILayout, context: bpy.types.Context, node: bpy.types.Node
) -> None:
    """Name the preset that was last applied to the node, and link to where its values are from."""
    try:
        applied = preset(node.get(PRESET_KEY, ""))
    except PresetError:  # none, one of the user's, or one of another version
        return
    column = layout.box().column(align=True)
    row = column.row()
    row.label(text=applied.name, icon="CHECKMARK")
    draw_lines(column, context, applied.source.title, "BLANK1")
    if applied.source.url:
        row.operator("wm.url_open", text="", icon="URL").url = applied.source.url


def _draw_library(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    if registered_libraries(context):
        layout.operator(MICROBOUNCE_OT_unregister_library.bl_idname, text="Remove Asset Library")
    else:  # greyed out where there is none: its tooltip says what to do
        layout.operator(MICROBOUNCE_OT_register_library.bl_idname, text="Add Asset Library")


class MICROBOUNCE_PT_shader_editor_presets(bpy.types.Panel):
    """Presets in the Shader editor."""

    bl_label = "Presets"
    bl_space_type = "NODE_EDITOR"
    bl_region_type = "UI"
    bl_category = "Microbounce"
    bl_parent_id = "MICROBOUNCE_PT_shader_editor"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show it where the editor is for the materials of objects."""
        return context.space_data.shader_type == "OBJECT"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the presets."""
        draw_presets(self.layout, context)


class MICROBOUNCE_PT_material_presets(bpy.types.Panel):
    """Presets in the material properties."""

    bl_label = "Presets"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    bl_parent_id = "MICROBOUNCE_PT_material"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the presets."""
        draw_presets(self.layout, context)


CLASSES = (
    MICROBOUNCE_MT_finishes,
    MICROBOUNCE_MT_user_presets,
    MICROBOUNCE_PT_shader_editor_presets,
    MICROBOUNCE_PT_material_presets,
)


def register() -> None:
    """Add the choices."""
    choice = bpy.props.EnumProperty(
        name="Presets Shown",
        description="Which presets the panel shows",
        items=[
            ("MATERIAL", "The Material's Kind", "Those of the kind of the material's node"),
            ("ALL", "All", "All presets"),
            *KIND_ITEMS,
        ],
    )
    setattr(bpy.types.WindowManager, SHOWN, choice)
    folded_out = bpy.props.BoolProperty(name="Pictures", description="Show pictures of the presets")
    setattr(bpy.types.WindowManager, OPEN, folded_out)


def unregister() -> None:
    """Take them out, and the pictures out of memory."""
    for name in (SHOWN, OPEN):
        delattr(bpy.types.WindowManager, name)
    preset_icons.release()
