# SPDX-License-Identifier: GPL-3.0-or-later
"""Applies presets and finishes to the material shown."""

from collections.abc import Callable
from functools import partial

import bpy

from ..core.kinds import KINDS
from ..core.presets.catalogue import finish, preset, presets
from ..core.presets.files import Finish, Preset, PresetError
from ..material.group import GROUP_ERRORS
from ..material.node import MaterialError, material_node, why_not_editable
from ..preferences import preferences
from ..presets.apply import (
    apply_finish,
    apply_preset,
    preset_material,
)
from ..presets.icons import icon
from . import material as object_material
from .osl import osl_status
from .polled import Polled

# Raised for a preset or a material that cannot be used. The messages are for users.
APPLY_ERRORS = (PresetError, MaterialError, TypeError, *GROUP_ERRORS)

# Blender does not copy the texts of a generated list, so they must stay referenced.
_search_items: list[tuple[str, str, str, int, int]] = []


def shown_material(context: bpy.types.Context) -> bpy.types.Material | None:
    """Return the material in the Shader editor or the material properties, pinned ones included.

    Elsewhere, or if a Shader editor shows none, it is the active object's.
    """
    space = context.space_data
    shown = getattr(context, "material", None)
    if space is not None and space.type == "NODE_EDITOR":
        shown = space.id
    if isinstance(shown, bpy.types.Material):
        return shown
    return context.object.active_material if context.object is not None else None


def why_no_preset(context: bpy.types.Context) -> str:
    """Return why no preset can be applied here, with the remedy; "" if one can."""
    material = shown_material(context)
    if material is None:
        return object_material.why_no_material(context.object)
    return why_not_editable(material)


def why_no_finish(context: bpy.types.Context) -> str:
    """Return why no finish can be applied here, with the remedy; "" if one can."""
    material = shown_material(context)
    if material is None or material_node(material) is None:
        return "No Microbounce node feeds the material's output: apply a preset first"
    return why_not_editable(material)


def apply_to_shown(
    context: bpy.types.Context, chosen: Preset, surface: Finish | None = None
) -> list[str]:
    """Apply a preset to the material shown, or put a new one into the active object's empty slot.

    Returns the labels that were left; raises one of APPLY_ERRORS. Ask why_no_preset() before.
    """
    material, quality = shown_material(context), preferences(context).quality
    if material is not None:
        return apply_preset(material, chosen, surface, quality)
    object_material.assign_material(context.object, preset_material(chosen, surface, quality))
    return []


def reported(
    operator: bpy.types.Operator, context: bpy.types.Context, work: Callable[[], list[str]]
) -> set[str]:
    """Run `work`, which returns the labels of inputs that were left; return the operator's result.

    Errors, those inputs, and a shader that will not run are reported.
    """
    try:
        left = work()
    except APPLY_ERRORS as error:
        operator.report({"ERROR"}, str(error))
        return {"CANCELLED"}
    if left:
        operator.report({"INFO"}, f"Left as they are, because they are linked: {', '.join(left)}")
    status = osl_status(context)
    if not status.ok:
        operator.report({"WARNING"}, status.message)
    return {"FINISHED"}


class AppliesPreset(Polled):
    """The base of operators that apply a preset."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why not, with the remedy."""
        return why_no_preset(context)

    def apply(
        self, context: bpy.types.Context, find: Callable[[], Preset], finish_name: str = ""
    ) -> set[str]:
        """Apply the preset that `find` returns and, unless its name is "", the finish."""

        def work() -> list[str]:
            surface = finish(finish_name) if finish_name else None
            return apply_to_shown(context, find(), surface)

        return reported(self, context, work)


class MICROBOUNCE_OT_apply_preset(AppliesPreset, bpy.types.Operator):
    """Apply one of the extension's presets."""

    bl_idname = "microbounce.apply_preset"
    bl_label = "Apply Microbounce Preset"
    bl_description = "Give the material the values of a measured one"

    identifier: bpy.props.StringProperty(
        name="Preset", description='Which preset, such as "conductor/gold"'
    )
    finish: bpy.props.StringProperty(
        name="Finish", description='What was done to its surface, such as "finish/brushed", or none'
    )

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """Tell in the tooltip of a button what the preset is and where it comes from."""
        try:
            chosen = preset(properties.identifier)
        except PresetError:
            return cls.bl_description
        return described(chosen)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply it."""
        return self.apply(context, partial(preset, self.identifier), self.finish)


class MICROBOUNCE_OT_search_preset(AppliesPreset, bpy.types.Operator):
    """Find a preset by typing a part of its name, its kind or one of its tags."""

    bl_idname = "microbounce.search_preset"
    bl_label = "Search Microbounce Presets"
    bl_description = "Find a preset by its name, kind or tags and apply it"
    bl_property = "identifier"

    identifier: bpy.props.EnumProperty(
        name="Preset",
        description="Which preset",
        items=lambda _operator, _context: search_items(),
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Open the search."""
        if not search_items():
            self.report({"ERROR"}, "There are no presets: install the extension again")
            return {"CANCELLED"}
        context.window_manager.invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply what was chosen."""
        return self.apply(context, partial(preset, self.identifier))


class MICROBOUNCE_OT_apply_finish(Polled, bpy.types.Operator):
    """Apply a finish to the material's node."""

    bl_idname = "microbounce.apply_finish"
    bl_label = "Apply Microbounce Finish"
    bl_description = "Change the surface of the material and keep its colour"
    bl_options = {"REGISTER", "UNDO"}

    identifier: bpy.props.StringProperty(
        name="Finish", description='Which finish, such as "finish/brushed"'
    )

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """Tell in the tooltip of an entry what the finish is."""
        try:
            return finish(properties.identifier).description.rstrip(".")
        except PresetError:
            return cls.bl_description

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why not, with the remedy."""
        return why_no_finish(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set its values."""
        material = shown_material(context)
        return reported(self, context, lambda: apply_finish(material, finish(self.identifier)))


def described(item: Preset | Finish) -> str:
    """Return the tooltip of a preset: what it is, and the title of its source."""
    return f"{item.name}: {item.description.rstrip('.')}. Source: {item.source.title.rstrip('.')}"


def search_items() -> list[tuple[str, str, str, int, int]]:
    """Return the items of the search, with names that hold kind and tags, and with pictures."""
    found = presets()
    shown = [(item.identifier, icon(item.identifier)) for item in found]
    if [(item[0], item[3]) for item in _search_items] != shown:
        _search_items[:] = [
            (
                item.identifier,
                f"{item.name} ({', '.join((KINDS[item.kind].label, *item.tags))})",
                described(item),
                picture,
                number,
            )
            for number, (item, (_, picture)) in enumerate(zip(found, shown, strict=True))
        ]
    return _search_items


CLASSES = (
    MICROBOUNCE_OT_apply_preset,
    MICROBOUNCE_OT_search_preset,
    MICROBOUNCE_OT_apply_finish,
)
