# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Cost in the render properties: options, progress, and the last result."""

from pathlib import Path

import bpy

from ..core.cost.options import OPTIONS
from ..core.run import Progress
from ..operators.cost import (
    MICROBOUNCE_OT_clear_cost_cache,
    MICROBOUNCE_OT_measure_cost,
    MICROBOUNCE_OT_show_cost_plot,
    last_measurement,
)
from .panels import draw_lines


class MICROBOUNCE_PT_cost(bpy.types.Panel):
    """What accuracy costs in this scene."""

    bl_label = "Microbounce Cost"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Show it for Cycles, in which our materials run."""
        return context.engine == "CYCLES"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the button or how far it is, and below it the last result."""
        layout = self.layout
        progress = MICROBOUNCE_OT_measure_cost.progress
        if progress is not None:
            _draw_progress(layout, progress)
        else:
            _draw_button(layout, context.window_manager.microbounce_cost)
        report = last_measurement()
        if report is not None:
            _draw_report(layout, context, report)


class MICROBOUNCE_PT_cost_options(bpy.types.Panel):
    """What is measured, and how."""

    bl_label = "Options"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_parent_id = "MICROBOUNCE_PT_cost"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the options, those that are seldom changed last."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        options = context.window_manager.microbounce_cost
        for option in OPTIONS:
            layout.prop(options, option.name)
        layout.operator(MICROBOUNCE_OT_clear_cost_cache.bl_idname)


def _draw_button(layout: bpy.types.UILayout, options: bpy.types.PropertyGroup) -> None:
    button = layout.operator(MICROBOUNCE_OT_measure_cost.bl_idname, icon="TIME")
    for option in OPTIONS:
        setattr(button, option.name, getattr(options, option.name))


def _draw_progress(layout: bpy.types.UILayout, progress: Progress) -> None:
    left = "" if progress.left is None else f", {_spent(progress.left)} left"
    layout.progress(factor=progress.part, text=f"{100 * progress.part:.0f} %{left}")
    layout.label(text=progress.text)
    layout.label(text="Esc cancels", icon="INFO")


def _draw_report(
    layout: bpy.types.UILayout, context: bpy.types.Context, report: dict[str, object]
) -> None:
    setting = report["setting"]
    box = layout.box()
    box.label(text=f"{setting['file']}, frame {setting['frame']}", icon="FILE_BLEND")
    column = box.column(align=True)
    draw_lines(column, context, report["sentence"], "BLANK1")
    grid = box.grid_flow(row_major=True, columns=4, even_columns=False, align=True)
    error = 100 * setting["error"]
    for heading in ("Variant", f"To {error:g} %", "Bias", "Noise"):
        grid.label(text=heading)
    for row in report["variants"]:
        for text in _cells(row):
            grid.label(text=text)
    box.operator(MICROBOUNCE_OT_show_cost_plot.bl_idname, icon="IMAGE_DATA")
    buttons = box.row(align=True)
    page = Path(report["files"]["page"])
    for text, path in (("Open Report", page), ("Open Folder", page.parent)):
        buttons.operator("wm.path_open", text=text).filepath = str(path)


def _cells(row: dict[str, object]) -> tuple[str, ...]:
    seconds = row["seconds_to_error"]
    time = "never" if row["timed"] and seconds is None else _spent(seconds)
    if row["timed"] and row["seconds_to_error_open"]:
        time += " ?"
    bias = f"{100 * row['bias']:.2g} %"
    if not row["bias_resolved"]:
        bias = f"< {100 * row['bias_resolution']:.2g} %"
    return (
        row["variant"],
        time,
        bias,
        f"{100 * row['noise']:.2g} %",
    )


def _spent(seconds: float | None) -> str:
    from ..core.cost.advice import spent

    return spent(seconds)


CLASSES = (MICROBOUNCE_PT_cost, MICROBOUNCE_PT_cost_options)
