# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what accuracy costs in the open scene, and what belongs to that."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ..core.run import RunError
from .following import FollowsRun
from .polled import Polled
from .redraw import redraw_panels

# Imported when it is used: a start of Blender pays nothing for it.
if TYPE_CHECKING:
    from ..core.cost.plan import Options
    from ..cost.run import CostRun

# What the last measurement of this session found, as Report.as_dict() has it; None before it.
_last: dict[str, object] | None = None


def last_report() -> dict[str, object] | None:
    """Return what the last measurement found, None before the first."""
    return _last


class CostOptions:
    """The options, for the operator and for the panel that hands them to it."""

    samples: bpy.props.IntProperty(
        name="Samples",
        description="Samples of each picture; 0 takes the scene's. Times and noise at other "
        "numbers follow from these",
        default=64,
        min=0,
        max=65536,
    )
    percentage: bpy.props.IntProperty(
        name="Size",
        description="Width and height in percent of the scene's resolution; 0 takes the scene's "
        "percentage",
        default=50,
        min=0,
        max=100,
        subtype="PERCENTAGE",
    )
    rounds: bpy.props.IntProperty(
        name="Rounds",
        description="How often each variant is rendered and timed, each time with other noise",
        default=3,
        min=2,
        max=32,
    )
    error: bpy.props.FloatProperty(
        name="Target Error",
        description="The times are those to this error, relative to the reference, in percent",
        default=2.0,
        min=0.01,
        max=99.0,
        subtype="PERCENTAGE",
    )
    steps: bpy.props.StringProperty(
        name="Qualities",
        description="Qualities to compare, with commas between",
        default="Single, Fitted, Walk, Exact",
    )
    bounces: bpy.props.StringProperty(
        name="Bounces",
        description="Limits of the bounces on the microsurface to compare, in Walk, with commas "
        "between; empty for none",
        default="1, 2, 4, 8, 16",
    )
    walks: bpy.props.StringProperty(
        name="Walks",
        description="Numbers of walks to compare, in Walk, with commas between; empty for none",
    )
    kernels: bpy.props.StringProperty(
        name="Kernels",
        description="Radii of the lobe to compare, in Walk, with commas between; empty for none",
    )
    baselines: bpy.props.BoolProperty(
        name="Cycles' Own",
        description="Compare Cycles' own materials of the same values too, with Open Shading "
        "Language on and off",
        default=True,
    )
    reference: bpy.props.EnumProperty(
        name="Reference",
        description="What the pictures are compared with",
        items=[
            ("WALK", "Walk", "Many narrow walks: sees all lights"),
            ("EXACT", "Exact", "No bias, but noise; not where lights have no size"),
        ],
    )
    reference_samples: bpy.props.IntProperty(
        name="Reference Samples",
        description="Samples of the reference; 0 takes 16 times those of a picture",
        default=0,
        min=0,
    )
    output: bpy.props.StringProperty(
        name="Output",
        description="Folder for the page, the tables and the plot; // is the file's own",
        default="//microbounce_cost",
        subtype="DIR_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )

    def asked(self) -> "Options":
        """Return what is asked for; raises PlanError for what makes no sense.

        It is not called `options`: every operator has something else by that name.
        """
        from ..core.cost.plan import Options, parse_numbers, parse_steps

        return Options(
            samples=self.samples,
            percentage=self.percentage,
            steps=parse_steps(self.steps),
            bounces=parse_numbers(self.bounces),
            walks=parse_numbers(self.walks),
            kernels=parse_numbers(self.kernels, float),
            baselines=self.baselines,
            rounds=self.rounds,
            reference=self.reference,
            reference_samples=self.reference_samples,
            error=self.error / 100.0,
        )


class MICROBOUNCE_PG_cost(CostOptions, bpy.types.PropertyGroup):
    """The options in the panel."""


class MICROBOUNCE_OT_measure_cost(CostOptions, FollowsRun, bpy.types.Operator):
    """Render the scene's variants in a Blender of their own, and report."""

    bl_idname = "microbounce.measure_cost"
    bl_label = "Measure Cost"
    bl_description = (
        "Render this view with each quality and with Cycles' own materials, in the background, "
        "and show how much time each takes to which error. Where the scene has a render region, "
        "that part alone is rendered. The scene stays as it is"
    )
    # No UNDO: nothing of the scene changes, and a step back should not be spent on it.
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
        """Begin to measure what is asked for."""
        from ..core.cost.plan import PlanError
        from ..cost.run import CostRun

        try:
            options = self.asked()
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
    """Remove the references that were kept."""

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
        """Return that nothing was measured; "" where there is a plot."""
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
