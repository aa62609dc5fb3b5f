# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the check for a farm."""

import bpy

from ..operators.farm import MICROBOUNCE_OT_check_farm, last_farm_findings
from .findings import draw_findings
from .panels import in_both_editors


class _FarmPanel:
    """What the check for a farm found last, with its buttons."""

    bl_label = "Farm"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the buttons and the findings."""
        layout = self.layout
        column = layout.column(align=True)
        column.operator(MICROBOUNCE_OT_check_farm.bl_idname, icon="VIEWZOOM")
        button = column.operator(
            MICROBOUNCE_OT_check_farm.bl_idname, text="Prove by Rendering", icon="RENDER_STILL"
        )
        button.prove = True
        findings = last_farm_findings(context.scene)
        if findings is not None:
            draw_findings(layout, context, findings)


CLASSES = in_both_editors(
    _FarmPanel, "MICROBOUNCE_PT_farm_shader_editor", "MICROBOUNCE_PT_farm_material"
)
