# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what accuracy costs in the open scene; shows the plot and clears the cache."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ..core.cost.options import OPTIONS, CostOption, options_of
from ..core.cost.plan import PlanError
from ..core.run import RunError
from .following import FollowsRun
from .polled import Polled
from .redraw import redraw_panels

# Imported when it is used, so that Blender starts no slower.
if TYPE_CHECKING:
    from ..cost.run import CostRun

# The last measurement of this session, as CostReport.as_dict() has it; None before the first.
_last: dict[str, object] | None = None


def last_measurement() -> dict[str, object] | None:
    """Return the last measurement, None before the first."""
    return _last


def _property(option: CostOption) -> object:
    """Return the property of an option."""
    shown = {"name": option.label, "description": option.help}
    if option.choices:
        items = [(name, name.title(), tooltip) for name, tooltip in option.choices]
        return bpy.props.EnumProperty(**shown, items=items, default=option.default)
    shown["default"] = option.default
    if isinstance(option.default, bool):
        return bpy.props.BoolProperty(**shown)
    if isinstance(option.default, str):
        if option.name != "output":
            return bpy.props.StringProperty(**shown)
        path = {"subtype": "DIR_PATH", "options": {"PATH_SUPPORTS_BLEND_RELATIVE"}}
        return bpy.props.StringProperty(**shown, **path)
    number = bpy.props.IntProperty if isinstance(option.default, int) else bpy.props.FloatProperty
    low, high = option.limits
    return number(**shown, min=low, max=high, subtype="PERCENTAGE" if option.percent else "NONE")


class CostOptions:
    """The options as properties, for the operator and for the panel that hands them to it."""

    __annotations__ = {option.name: _property(option) for option in OPTIONS}


class MICROBOUNCE_PG_cost(CostOptions, bpy.types.PropertyGroup):
    """The options in the panel."""


class MICROBOUNCE_OT_measure_cost(CostOptions, FollowsRun, bpy.types.Operator):
    """Render the scene's variants in another Blender, and report."""

    bl_idname = "microbounce.measure_cost"
    bl_label = "Measure Cost"
    bl_description = (
        "Render this view with each quality and with Cycles' own materials, in the background, "
        "and show how much time each takes to which error. If the scene has a render region, only "
        "that part is rendered. The scene stays as it is"
    )
    # No UNDO, because nothing in the scene changes.
    bl_options = {"REGISTER"}

    title = "Measuring the cost"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow one at a time, in a scene with a camera."""
        if context.scene.camera is None:
            cls.poll_message_set("The scene has no camera: add one")
            return False
        return cls.is_idle()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start it and go on while Blender is used."""
        return self.follow(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Measure and wait for it, as scripts want it."""
        return self.wait(context)

    def start(self, context: bpy.types.Context) -> "CostRun":
        """Start to measure."""
        from ..cost.run import CostRun

        try:
            options = options_of({option.name: getattr(self, option.name) for option in OPTIONS})
        except PlanError as error:
            raise RunError(str(error)) from error
        return CostRun(context.scene, context.view_layer, options, self.output)

    def finish(self, context: bpy.types.Context, result: dict[str, object]) -> set[str]:
        """Keep the report for the panel."""
        global _last
        _last = result
        redraw_panels(context)
        self.report({"INFO"}, result["sentence"])
        return {"FINISHED"}


class MICROBOUNCE_OT_clear_cost_cache(bpy.types.Operator):
    """Remove the stored references."""

    bl_idname = "microbounce.clear_cost_cache"
    bl_label = "Clear Cost Cache"
    bl_description = "Remove the reference pictures that were kept from earlier measurements"
    bl_options = {"REGISTER"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove them and say how many there were."""
        from ..cost.reference_cache import cache_folder, clear_cache

        try:
            count = clear_cache()
        except OSError as error:
            self.report({"ERROR"}, f"{cache_folder()} cannot be removed: {error}. Remove it")
            return {"CANCELLED"}
        self.report({"INFO"}, f"{count} reference{'' if count == 1 else 's'} removed")
        return {"FINISHED"}


class MICROBOUNCE_OT_show_cost_plot(Polled, bpy.types.Operator):
    """Open the plot."""

    bl_idname = "microbounce.show_cost_plot"
    bl_label = "Show Plot"
    bl_description = "Open the plot of the last measurement in the program that shows SVG files"
    bl_options = {"REGISTER"}

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return that nothing was measured; "" if there is a plot."""
        return "" if _last is not None else "There is no plot: press Measure Cost first"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Open the file."""
        path = _last["files"]["plot"]
        if not Path(path).is_file():
            self.report({"ERROR"}, f"{path} is gone: measure again")
            return {"CANCELLED"}
        return bpy.ops.wm.path_open(filepath=path)


CLASSES = (
    MICROBOUNCE_PG_cost,
    MICROBOUNCE_OT_measure_cost,
    MICROBOUNCE_OT_show_cost_plot,
    MICROBOUNCE_OT_clear_cost_cache,
)


def register() -> None:
    """Add the panel's options to the window manager: they are not part of the scene."""
    bpy.types.WindowManager.microbounce_cost = bpy.props.PointerProperty(type=MICROBOUNCE_PG_cost)


def unregister() -> None:
    """Take them out, and forget the last report."""
    global _last
    del bpy.types.WindowManager.microbounce_cost
    _last = None
