# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports whether the shaders run in the scene, and offers to switch OSL on."""

import bpy

from ..core.osl_state import Status
from ..scene.status import scene_status
from .exact import missed_lights
from .polled import Polled


def osl_status(context: bpy.types.Context) -> Status:
    """Return whether the shaders run in the context's scene, or why not and what to do."""
    return scene_status(context.scene, context.preferences)


class MICROBOUNCE_OT_enable_osl(Polled, bpy.types.Operator):
    """Set the scene's switch for Open Shading Language."""

    bl_idname = "microbounce.enable_osl"
    bl_label = "Enable Open Shading Language"
    bl_description = (
        "Switch Open Shading Language on for this scene, which Microbounce materials need"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why it would not help; "" if it does."""
        status = osl_status(context)
        if not status.can_enable:
            return status.message or "Open Shading Language is on"
        if not context.scene.is_editable:
            return f"The scene '{context.scene.name}' is linked from a library: switch it on there"
        return ""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the switch; warn if the device has no OSL or lights will be missed."""
        context.scene.cycles.shading_system = True
        status = osl_status(context)
        warning = status.message or missed_lights(context)
        if warning:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_enable_osl,)
