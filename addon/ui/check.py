# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the check before rendering."""

import bpy

from ..operators.check import MICROBOUNCE_OT_check_render
from ..scene.before_render import last_render_findings
from .findings import draw_findings
from .panels import in_both_editors


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


CLASSES = in_both_editors(
    _CheckPanel, "MICROBOUNCE_PT_check_shader_editor", "MICROBOUNCE_PT_check_material"
)
