# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the analysis."""

from typing import TYPE_CHECKING

import bpy

from ..core.analysis.picture_error import percent
from ..operators.analyse import MICROBOUNCE_OT_analyse, MICROBOUNCE_OT_apply_analysis, last_analysis
from ..preferences import stored_preferences
from ..text import label
from .panels import draw_lines, in_both_editors

if TYPE_CHECKING:
    from ..analysis.analyse import Analysis, Row

# The most rows that a panel shows, changes first.
_MOST_ROWS = 24


def draw_analysis(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the tolerance, the buttons, and the last analysis of the scene."""
    stored = stored_preferences(context)
    if stored is not None:
        layout.prop(stored, "tolerance")
    row = layout.row(align=True)
    row.operator(MICROBOUNCE_OT_analyse.bl_idname)
    row.operator(MICROBOUNCE_OT_apply_analysis.bl_idname)
    analysis = last_analysis(context)
    if analysis is not None:
        _draw_analysis_table(layout, context, analysis)


def _draw_analysis_table(
    layout: bpy.types.UILayout, context: bpy.types.Context, analysis: "Analysis"
) -> None:
    if not analysis.rows:
        layout.label(text="No object shows a Microbounce material", icon="INFO")
        return
    if not analysis.has_camera:
        layout.label(text="Shares are equal: there is no camera to find them", icon="INFO")
    if analysis.part < 1.0:
        text = label(
            "Shares are rough: time ran out after {part} of the rays", part=percent(analysis.part)
        )
        layout.label(text=text, icon="INFO")
    changes = analysis.changes
    rows = (*changes, *(row for row in analysis.rows if row not in changes))
    for row in rows[:_MOST_ROWS]:
        _draw_row(layout.box().column(align=True), context, row)
    if len(rows) > _MOST_ROWS:
        layout.label(text=label("{count} more", count=len(rows) - _MOST_ROWS))
    column = layout.column(align=True)
    column.label(
        text=label(
            "Picture: {now} off, then {then}",
            now=percent(analysis.error_now),
            then=percent(analysis.error_then),
        )
    )
    if not analysis.within_tolerance:
        column.label(text="No choice of steps is within the tolerance", icon="INFO")
    column.label(
        text=label("Time of a sample: {ratio:.2f} times today's", ratio=analysis.time_ratio)
    )


def _draw_row(column: bpy.types.UILayout, context: bpy.types.Context, row: "Row") -> None:
    one = row.proposal
    column.label(text=row.name, icon="MATERIAL")
    column.label(text=label("{share} of the picture", share=percent(one.share)), icon="BLANK1")
    now, error = one.now, percent(one.error_now)
    if one.changes:
        then = percent(one.error_then)
        column.label(text=label("{now} to {then}", now=now, then=one.then), icon="FORWARD")
        text = label("Off by {now}, then {then}", now=error, then=then)
        column.label(text=text, icon="BLANK1")
    else:
        column.label(text=label("{now}: off by {error}", now=now, error=error), icon="CHECKMARK")
    for text in (one.reason, *row.notes):
        draw_lines(column, context, text[:1].upper() + text[1:], "BLANK1")


class _AnalysisPanel:
    """The last analysis of the scene, with its buttons."""

    bl_label = "Analysis"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the buttons and the table."""
        draw_analysis(self.layout, context)


CLASSES = in_both_editors(
    _AnalysisPanel, "MICROBOUNCE_PT_analysis_shader_editor", "MICROBOUNCE_PT_analysis_material"
)
