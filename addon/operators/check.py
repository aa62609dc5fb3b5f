# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the check on demand that also runs before each render."""

import bpy

from ..scene.before_render import check_scene, forget, remember
from ..text import message
from .redraw import redraw_panels


class MICROBOUNCE_OT_check_render(bpy.types.Operator):
    """Report what keeps our materials in the scene from looking as they should."""

    bl_idname = "microbounce.check_render"
    bl_label = "Check Before Rendering"
    bl_description = (
        "Report what keeps Microbounce materials in this scene from looking as they should. "
        "Nothing is changed"
    )
    bl_options = {"REGISTER"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Report each finding as a warning at most, because errors would stop scripts."""
        findings = check_scene(context.scene, context.preferences)
        if findings is None:
            forget(context.scene)
            self.report({"INFO"}, message("No Microbounce material is rendered in this scene"))
            return {"FINISHED"}
        remember(context.scene, findings)
        redraw_panels(context)
        for finding in findings:
            self.report({"INFO" if finding.level == "note" else "WARNING"}, finding.text)
        if not findings:
            self.report({"INFO"}, message("The Microbounce materials will render as they should"))
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_check_render,)
