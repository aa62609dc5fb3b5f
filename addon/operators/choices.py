# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets a parameter of the material's node that is a choice, such as Quality, by its name."""

import bpy

from ..material.node import material_node, set_values
from .polled import Polled
from .presets import APPLY_ERRORS, shown_material, why_no_finish


class MICROBOUNCE_OT_set_choice(Polled, bpy.types.Operator):
    """Set one choice of the node that feeds the output of the material shown."""

    bl_idname = "microbounce.set_choice"
    bl_label = "Set Microbounce Choice"
    bl_description = "Choose this for the material's Microbounce node"
    bl_options = {"REGISTER", "UNDO"}

    parameter: bpy.props.StringProperty(
        name="Parameter", description='Which parameter, such as "Quality"'
    )
    value: bpy.props.StringProperty(name="Value", description='Its new value, such as "Walk"')

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why not, with the remedy."""
        return why_no_finish(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set it, unless the input is linked."""
        node = material_node(shown_material(context))
        try:
            left = set_values(node, {self.parameter: self.value})
        except APPLY_ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if left:
            self.report({"ERROR"}, f"{left[0]} takes what is linked to it: cut the link first")
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_set_choice,)
