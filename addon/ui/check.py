# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the check before rendering."""

import bpy

from ..operators.check import MICROBOUNCE_OT_check_render
from ..scene.before_render import last_render_findings
from .findings import draw_findings
from .panels import MICROBOUNCE_PT_material, MICROBOUNCE_PT_shader_editor


class _CheckPanel:
    """What the check found last; it also runs before each render."""

    bl_label = "Before Rendering"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button and the findings."""
        layout = self.layout
        layout.operator(MICROBOUNCE_OT_check_render.bl_idname, icon="VIEWZOOM")
        findings = last_render_findings(context.scene)
        if findings is not None:
            draw_findings(layout, context, findings)


class MICROBOUNCE_PT_check_shader_editor(_CheckPanel, bpy.types.Panel):
    """The check in the Shader editor."""

    bl_space_type = "NODE_EDITOR"
    bl_region_type = "UI"
    bl_category = "Microbounce"
    bl_parent_id = MICROBOUNCE_PT_shader_editor.__name__


class MICROBOUNCE_PT_check_material(_CheckPanel, bpy.types.Panel):
    """The check in the material properties."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    bl_parent_id = MICROBOUNCE_PT_material.__name__


CLASSES = (MICROBOUNCE_PT_check_shader_editor, MICROBOUNCE_PT_check_material)
