# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates the materials of a file to today's node groups."""

from typing import TYPE_CHECKING

import bpy

from ..material.group import GROUP_ERRORS
from .polled import Polled

# Imported when it is first used, so that Blender starts no slower.
if TYPE_CHECKING:
    from ..material.update import Update


class MICROBOUNCE_OT_update_materials(Polled, bpy.types.Operator):
    """Replace older node groups by today's."""

    bl_idname = "microbounce.update_materials"
    bl_label = "Update Materials"
    bl_description = (
        "Give all Microbounce nodes that older versions left in this file today's node groups, "
        "with their values and links"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why nothing can be updated, with the remedy; "" if something can."""
        from ..material.update import old_groups

        try:
            found = old_groups()
        except GROUP_ERRORS as error:
            return str(error)
        return "" if found else "All Microbounce materials of this file are of this version"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Update, and report what was lost or could not be changed."""
        from ..material.update import update_materials

        try:
            done = update_materials()
        except GROUP_ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for line in (*done.lost, *done.stay):
            self.report({"WARNING"}, line)
        self.report({"INFO"}, _summary(done))
        return {"FINISHED"}


def _summary(done: "Update") -> str:
    parts = [f"Nodes updated: {done.nodes}"]
    if done.lost:
        parts.append(f"values and links that have no place any more: {len(done.lost)}")
    if done.stay:
        parts.append(f"nodes that stay old: {len(done.stay)}")
    return "; ".join(parts)


CLASSES = (MICROBOUNCE_OT_update_materials,)
