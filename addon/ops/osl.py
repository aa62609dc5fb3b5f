# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports whether the shaders run in the scene, and offers to switch OSL on."""

import bpy

from ..core.osl_state import Status, osl_state
from ..nodes.script import osl_compiler_available
from .exact import missed_lights


def osl_status(context: bpy.types.Context) -> Status:
    """Return whether the shaders run in the context's scene, else why not and what to do."""
    scene = context.scene
    cycles = getattr(scene, "cycles", None)  # absent where the Cycles add-on is disabled
    return osl_state(
        built_with_osl=osl_compiler_available(),
        engine=scene.render.engine,
        shading_system=bool(cycles and cycles.shading_system),
        device=_render_device(context),
    )


def _render_device(context: bpy.types.Context) -> str:
    """Return "CPU", or the GPU type where the scene asks for GPUs and the preferences have one."""
    cycles = getattr(context.scene, "cycles", None)
    addon = context.preferences.addons.get("cycles")
    if cycles is None or addon is None or cycles.device == "CPU":
        return "CPU"
    preferences = addon.preferences
    # Like Cycles, which takes the CPU where no GPU is chosen.
    return preferences.compute_device_type if preferences.has_active_device() else "CPU"


class MICROBOUNCE_OT_enable_osl(bpy.types.Operator):
    """Set the scene's switch for Open Shading Language."""

    bl_idname = "microbounce.enable_osl"
    bl_label = "Enable Open Shading Language"
    bl_description = (
        "Switch Open Shading Language on for this scene, which Microbounce materials need"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it where it helps; say why where it does not."""
        status = osl_status(context)
        if status.can_enable:
            return True
        cls.poll_message_set(status.message or "Open Shading Language is on")
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the switch; warn where the device stands in the way or lights will be missed."""
        context.scene.cycles.shading_system = True
        status = osl_status(context)
        warning = status.message or missed_lights(context)
        if warning:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_enable_osl,)
