# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: whether materials and scene will render without the extension."""

from dataclasses import replace

import bpy

from ..core.finding import Finding
from ..core.osl_state import osl_state
from ..scene.usage import Use, material_uses
from .resources import (
    image_findings,
    library_findings,
    node_file_findings,
    other_file_findings,
    script_findings,
)
from .shaders import shader_findings


def farm_findings(scene: bpy.types.Scene) -> list[Finding]:
    """Return what may make our materials in this file render differently without the extension.

    Nothing is changed. Findings of an unused material are notes. A file without our materials has
    only findings of its libraries, which may hold some.
    """
    uses = list(material_uses())
    used = [use for use in uses if use.used]
    found = library_findings() + (scene_findings(scene) if used else [])
    for group, materials in _by_group(uses).items():
        needed = any(use.used for use in materials)
        found += [
            finding if needed else replace(finding, level="note")
            for finding in shader_findings(group)
        ]
    found += image_findings(used) + script_findings(used)
    return found + (node_file_findings(used) + other_file_findings(used) if used else [])


def scene_findings(scene: bpy.types.Scene) -> list[Finding]:
    """Return what keeps a scene from running our shaders on any machine."""
    subject = f"Scene '{scene.name}'"
    cycles = getattr(scene, "cycles", None)  # absent if the Cycles add-on is disabled
    status = osl_state(
        built_with_osl=True,
        engine=scene.render.engine,
        shading_system=bool(cycles and cycles.shading_system),
        device="CPU",
    )
    if not status.ok:
        return [Finding("error", subject, status.reason, status.remedy)]
    if cycles.device == "CPU":
        return []
    message = "It asks for a GPU. Unless that runs OptiX, Cycles' own material shows."
    return [Finding("warning", subject, message, "Set the device to CPU, or use OptiX.")]


def _by_group(uses: list[Use]) -> dict[bpy.types.NodeTree, list[Use]]:
    users: dict[bpy.types.NodeTree, list[Use]] = {}
    for use in uses:
        for group in use.groups:
            if group.is_missing:  # library_findings() names its library
                continue
            users.setdefault(group, []).append(use)
    return users
