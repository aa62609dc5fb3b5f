# SPDX-License-Identifier: GPL-3.0-or-later
"""Analyses the scene's materials, keeps the table in memory, and applies it."""

from typing import TYPE_CHECKING

import bpy

from ..core.analysis.picture_error import DEFAULT_TOLERANCE, percent
from ..core.run import PiecewiseRun
from ..preferences import preferences
from ..text import message
from .following import FollowsRun
from .redraw import redraw_panels

# The module that does the work is imported when it is needed, so Blender starts no slower.
if TYPE_CHECKING:
    from ..analysis.analyse import Analysis

# Time for images and shares of the picture, so that no scene holds Blender up for long.
_SECONDS = 5.0

# The last analysis and its file. Nothing of it is stored in the file.
_kept: "tuple[str, Analysis] | None" = None


def last_analysis(context: bpy.types.Context) -> "Analysis | None":
    """Return the last analysis of the context's scene, None if there is none."""
    if _kept is None:
        return None
    path, analysis = _kept
    return analysis if (path, analysis.scene) == (bpy.data.filepath, context.scene.name) else None


class MICROBOUNCE_OT_analyse(FollowsRun, bpy.types.Operator):
    """Make the table of proposals; change nothing."""

    bl_idname = "microbounce.analyse"
    bl_label = "Analyse Materials"
    bl_description = (
        "Find the cheapest Quality and Max Bounces of every Microbounce material that keep the "
        "picture within the tolerance. Nothing is changed"
    )
    bl_options = {"REGISTER"}

    tolerance: bpy.props.FloatProperty(
        name="Tolerance",
        description="How far off the picture may be, apart from noise: the root of its mean "
        "squared error, relative to the picture. Unless given, it is that of the preferences",
        default=DEFAULT_TOLERANCE,
        min=0.0005,
        max=1.0,
        soft_max=0.1,
        step=0.1,
        precision=4,
        options={"SKIP_SAVE"},
    )

    title = "Analysis"
    alone = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow one at a time."""
        return cls.is_idle()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Analyse the scene; Esc cancels."""
        return self.follow(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Analyse the scene, and wait for the end."""
        return self.wait(context)

    def start(self, context: bpy.types.Context) -> "PiecewiseRun[Analysis]":
        """Start the analysis."""
        from ..analysis.analyse import analysis_pieces

        given = self.properties.is_property_set("tolerance")
        tolerance = self.tolerance if given else preferences(context).tolerance
        return PiecewiseRun(analysis_pieces(context, tolerance, _SECONDS))

    def finish(self, context: bpy.types.Context, analysis: "Analysis") -> set[str]:
        """Keep the table for the panels, and report how many materials could change."""
        global _kept
        _kept = (bpy.data.filepath, analysis)
        redraw_panels(context)
        if not analysis.rows:
            self.report({"WARNING"}, "No object of the scene shows a Microbounce material")
            return {"FINISHED"}
        count = len(analysis.changes)
        self.report(
            {"INFO"},
            message(
                "{count} of {all} materials could change; the picture would be {error} off",
                count=count,
                all=len(analysis.rows),
                error=percent(analysis.error_then),
            ),
        )
        return {"FINISHED"}


class MICROBOUNCE_OT_apply_analysis(bpy.types.Operator):
    """Set what the last analysis proposed."""

    bl_idname = "microbounce.apply_analysis"
    bl_label = "Apply Analysis"
    bl_description = "Set Quality and Max Bounces of the materials as the table proposes"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it after an analysis that proposes something; say why otherwise."""
        analysis = last_analysis(context)
        if analysis is None:
            cls.poll_message_set("There is no analysis of this scene: press Analyse Materials")
            return False
        if not analysis.changes:
            cls.poll_message_set("The analysis proposes no change")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the values; name the nodes that were left because they have changed since."""
        from ..analysis.analyse import apply_analysis

        done, left = apply_analysis(context, last_analysis(context))
        names = ", ".join(left)
        if not done:
            text = "Nothing was set. Changed since the analysis: {names}. Analyse again"
            self.report({"ERROR"}, message(text, names=names))
            return {"CANCELLED"}
        if left:
            text = "{count} set. Changed since the analysis and left: {names}. Analyse again"
            self.report({"WARNING"}, message(text, count=len(done), names=names))
        else:
            self.report({"INFO"}, message("{count} materials set", count=len(done)))
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_analyse, MICROBOUNCE_OT_apply_analysis)


def register() -> None:
    """Start without a table."""
    global _kept
    _kept = None


unregister = register  # and end without one
