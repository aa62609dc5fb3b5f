# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts native materials to ours and back."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import bpy

from ..material.graph import surface_materials
from ..material.group import GROUP_ERRORS
from .osl import osl_status
from .polled import Polled
from .presets import shown_material

# Imported when it is first used, so that Blender starts no slower.
if TYPE_CHECKING:
    from ..convert import Conversion

Function = Callable[[bpy.types.Material], "Conversion"]

_SCOPES = (
    (
        "ACTIVE",
        "Active Material",
        "The material in the editor, elsewhere in the active object's active slot",
    ),
    ("SELECTED", "Selected Objects", "All materials of the selected objects"),
    ("ALL", "All Materials", "All materials of this file"),
)


def materials_in(context: bpy.types.Context, scope: str) -> list[bpy.types.Material]:
    """Return the materials of "ACTIVE", "SELECTED" or "ALL", each once, in the file's order."""
    if scope == "ALL":
        return surface_materials()
    if scope == "SELECTED":
        found = {s.material for obj in context.selected_objects for s in obj.material_slots}
    else:
        found = {shown_material(context)}
    return [material for material in surface_materials() if material in found]


def _needs_materials(scope: str) -> str:
    return {
        "ACTIVE": "The active object has no surface material: select one that has",
        "SELECTED": "The selected objects have no surface materials: select some that have",
        "ALL": "There are no surface materials in this file: add one",
    }[scope]


class _Converts(Polled):
    """What both directions share; a subclass has a `planner` and a `converter`."""

    bl_options = {"REGISTER", "UNDO"}

    scope: bpy.props.EnumProperty(name="Scope", description="Which materials", items=_SCOPES)
    # Hidden in the panel of the last operation, because a finished conversion is no dry run.
    dry_run: bpy.props.BoolProperty(
        name="Dry Run",
        description="Report what would be done, and change nothing",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return that the file has no materials; "" if it has."""
        return "" if surface_materials() else _needs_materials("ALL")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Convert, and report every node that changes its look or stays, and a summary.

        A dry run ends as cancelled, because a finished operator leaves a step to undo.
        """
        materials = materials_in(context, self.scope)
        if not materials:
            self.report({"ERROR"}, _needs_materials(self.scope))
            return {"CANCELLED"}
        try:
            done = self._convert(context.window_manager, materials)
        except GROUP_ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for conversion in done:
            self._report(conversion)
        self.report({"INFO"}, summary(done, self.dry_run))
        self.warn(context)
        return {"CANCELLED" if self.dry_run else "FINISHED"}

    def warn(self, context: bpy.types.Context) -> None:
        """Warn of problems with the result; a subclass may have some."""

    def _convert(
        self, manager: bpy.types.WindowManager, materials: list[bpy.types.Material]
    ) -> "list[Conversion]":
        function = self.planner() if self.dry_run else self.converter(materials)
        manager.progress_begin(0, len(materials))
        try:
            done = []
            for number, material in enumerate(materials):
                manager.progress_update(number)
                done.append(function(material))
            return done
        finally:
            manager.progress_end()

    def _report(self, conversion: "Conversion") -> None:
        for entry, line in zip(conversion.entries, conversion.lines, strict=True):
            noteworthy = entry.reason or entry.notes
            if noteworthy or self.dry_run:
                self.report({"WARNING" if noteworthy else "INFO"}, line)


def summary(done: "list[Conversion]", dry_run: bool) -> str:
    """Return in one line how many materials were converted, or would be in a dry run."""
    changed = [conversion for conversion in done if conversion.converted]
    nodes = sum(len(conversion.converted) for conversion in changed)
    approximated = sum(len(conversion.approximated) for conversion in done)
    refused = sum(len(conversion.refused) for conversion in done)
    verb = "would be converted" if dry_run else "converted"
    noun = "node" if nodes == 1 else "nodes"
    parts = [f"{len(changed)} of {len(done)} materials {verb} ({nodes} {noun})"]
    if approximated:
        parts.append(f"{approximated} will look a little different")
    if refused:
        parts.append(f"{refused} cannot be converted")
    if approximated or refused:
        parts.append("see the Info editor")
    return "; ".join(parts)


class MICROBOUNCE_OT_to_microbounce(_Converts, bpy.types.Operator):
    """Replace native nodes by ours."""

    bl_idname = "microbounce.to_microbounce"
    bl_label = "Convert to Microbounce"
    bl_description = (
        "Replace Metallic, Glossy, Glass, Diffuse and plain Principled BSDF nodes by Microbounce "
        "nodes of the same values and links"
    )

    def planner(self) -> Function:
        """Return what plans the conversion of a material."""
        from ..convert import TO_OURS, plan

        return partial(plan, direction=TO_OURS)

    def converter(self, materials: list[bpy.types.Material]) -> Function:
        """Return the converter of each of `materials`. It raises here if a group cannot be made."""
        from ..convert import needed_groups, to_microbounce

        return partial(to_microbounce, groups=needed_groups(materials))

    def warn(self, context: bpy.types.Context) -> None:
        """Warn if the shaders will not run."""
        status = osl_status(context)
        if not status.ok:
            self.report({"WARNING"}, status.message)


class MICROBOUNCE_OT_to_native(_Converts, bpy.types.Operator):
    """Replace our nodes by native ones."""

    bl_idname = "microbounce.to_native"
    bl_label = "Convert to Cycles"
    bl_description = (
        "Replace Microbounce nodes by the Cycles nodes that they were made from, or the nearest"
    )

    def planner(self) -> Function:
        """Return what plans the conversion of a material."""
        from ..convert import TO_NATIVE, plan

        return partial(plan, direction=TO_NATIVE)

    def converter(self, materials: list[bpy.types.Material]) -> Function:
        """Return what converts a material."""
        from ..convert import to_native

        return to_native


CLASSES = (MICROBOUNCE_OT_to_microbounce, MICROBOUNCE_OT_to_native)
