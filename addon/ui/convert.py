# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Convert below those of Microbounce."""

import bpy

from ..operators.convert import MICROBOUNCE_OT_to_microbounce, MICROBOUNCE_OT_to_native
from ..operators.update import MICROBOUNCE_OT_update_materials
from .panels import in_both_editors


class _Convert:
    """What the panel shows in both editors."""

    bl_label = "Convert"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw a menu of scopes for each direction, to convert and to try out, and the update."""
        for operator, text in (
            (MICROBOUNCE_OT_to_microbounce, "To Microbounce"),
            (MICROBOUNCE_OT_to_native, "To Cycles"),
        ):
            row = self.layout.split(factor=0.62, align=True)
            row.operator_menu_enum(operator.bl_idname, "scope", text=text)
            row.operator_menu_enum(operator.bl_idname, "scope", text="Dry Run").dry_run = True
        self.layout.operator(MICROBOUNCE_OT_update_materials.bl_idname, icon="FILE_REFRESH")


CLASSES = in_both_editors(
    _Convert, "MICROBOUNCE_PT_convert_nodes", "MICROBOUNCE_PT_convert_material"
)
