# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the active object a new material."""

import bpy

from ..core.kinds import KINDS
from ..material.group import GROUP_ERRORS
from ..material.node import new_material
from ..preferences import preferences
from .kinds import KIND_ITEMS
from .osl import osl_status
from .polled import Polled

# Types whose data have surface materials. Volumes have no surface; grease pencil has its own.
_TYPES = frozenset({"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD"})


def why_no_material(obj: bpy.types.Object | None) -> str:
    """Return why `obj` cannot be given a material, with the remedy; "" if it can."""
    if obj is None:
        return "There is no active object: select one"
    if obj.type not in _TYPES:
        kind = obj.type.replace("_", " ").lower()
        return f"'{obj.name}' is of type {kind} and has no surface: select a mesh or a curve"
    if not obj.is_editable:
        return f"'{obj.name}' is linked from a library: make it local or a library override"
    if not obj.material_slots and not _keeps_materials(obj.data):
        return (
            f"The data of '{obj.name}' are linked from a library and have no material slot: "
            "make the data local"
        )
    return ""


def _keeps_materials(data: bpy.types.ID) -> bool:
    """Return whether a file keeps what is put into the materials of an object's `data`."""
    return data.is_editable and data.override_library is None


def assign_material(obj: bpy.types.Object, material: bpy.types.Material) -> None:
    """Put `material` into the active slot of `obj`, or into a new one if it has none.

    If the object's data is linked, the slot switches from the data to the object.
    """
    if not obj.material_slots:
        obj.data.materials.append(material)
        return
    slot = obj.material_slots[obj.active_material_index]
    if slot.link == "DATA" and not _keeps_materials(obj.data):
        slot.link = "OBJECT"
    slot.material = material


class MICROBOUNCE_OT_add_material(Polled, bpy.types.Operator):
    """Give the active object a new Microbounce material."""

    bl_idname = "microbounce.add_material"
    bl_label = "Add Microbounce Material"
    bl_description = "Put a new Microbounce material into the active object's material slot"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", description="What it is made of", items=KIND_ITEMS)

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """Name the kind in the tooltip of a button."""
        name = KINDS[properties.kind].name
        return f"Put a new {name} material into the active object's material slot"

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why not, with the remedy."""
        return why_no_material(context.object)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make the material, assign it, and warn if its shader will not run."""
        obj = context.object
        try:
            quality = preferences(context).quality
            material = new_material(self.kind, KINDS[self.kind].name, Quality=quality)
        except GROUP_ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        assign_material(obj, material)
        status = osl_status(context)
        if not status.ok:
            self.report({"WARNING"}, status.message)
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_add_material,)
