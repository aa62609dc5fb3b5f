# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from a scene and the preferences whether the shaders run."""

import bpy

from ..core.osl_state import Status, osl_state
from ..material.script import osl_compiler_available


def scene_status(scene: bpy.types.Scene, preferences: bpy.types.Preferences) -> Status:
    """Return whether the shaders run in `scene`, or why not and what to do."""
    cycles = getattr(scene, "cycles", None)  # absent if the Cycles add-on is disabled
    return osl_state(
        built_with_osl=osl_compiler_available(),
        engine=scene.render.engine,
        shading_system=bool(cycles and cycles.shading_system),
        device=_render_device(scene, preferences),
    )


def _render_device(scene: bpy.types.Scene, preferences: bpy.types.Preferences) -> str:
    """Return "CPU", or the GPU type if the scene asks for GPUs and the preferences have one."""
    cycles = getattr(scene, "cycles", None)
    addon = preferences.addons.get("cycles")
    if cycles is None or addon is None or cycles.device == "CPU":
        return "CPU"
    # Cycles takes the CPU too if no GPU is chosen.
    chosen = addon.preferences
    return chosen.compute_device_type if chosen.has_active_device() else "CPU"
