# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks on demand whether the file renders on a farm without the extension as it does here."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ..core.finding import Finding, by_level, counts, worst
from ..core.run import RunError
from ..text import message
from .following import FollowsRun
from .redraw import redraw_panels

# Imported when it is used, so that Blender starts no slower.
if TYPE_CHECKING:
    from ..farm.proof import Proof, ProofRun

_PROVE = "Also render the saved file small, with and without the extension, and compare"

# The findings of the last check, by the scene's number in this session.
_last: dict[int, tuple[Finding, ...]] = {}


def last_farm_findings(scene: bpy.types.Scene) -> tuple[Finding, ...] | None:
    """Return what the last check of `scene` found, None if there was none."""
    return _last.get(scene.session_uid)


class MICROBOUNCE_OT_check_farm(FollowsRun, bpy.types.Operator):
    """Report what may make our materials render differently without the extension."""

    bl_idname = "microbounce.check_farm"
    bl_label = "Check for Farm"
    bl_description = (
        "Report what may make the Microbounce materials of this file render differently on a "
        "computer without the extension. Nothing is changed"
    )
    bl_options = {"REGISTER"}

    title = "Proof by rendering"

    prove: bpy.props.BoolProperty(
        name="Prove by Rendering",
        description=_PROVE,
        default=False,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """Say what the button that renders does beyond the check."""
        return _PROVE if properties.prove else ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow one at a time."""
        return cls.is_idle()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Check; the proof runs while Blender stays usable."""
        return self.follow(context) if self.prove else self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Check, and wait for the proof."""
        return self.wait(context) if self.prove else self.finish(context, None)

    def start(self, context: bpy.types.Context) -> "ProofRun":
        """Start to prove the saved file."""
        from ..farm.proof import ProofRun

        # Without a window Blender does not keep track of changes.
        changed = bpy.data.is_dirty and not bpy.app.background
        if not bpy.data.is_saved or changed:
            raise RunError(message("The proof renders the file as it is saved: save it first"))
        return ProofRun(Path(bpy.data.filepath))

    def finish(self, context: bpy.types.Context, result: "Proof | None") -> set[str]:
        """Check, keep all findings for the panel, and report how many there are."""
        from ..farm.check import farm_findings

        findings = farm_findings(context.scene)
        if result is not None:
            findings += result.findings(Path(bpy.data.filepath))
        _last[context.scene.session_uid] = by_level(findings)
        redraw_panels(context)
        if worst(findings) in ("error", "warning"):
            text = message("Found by the check for a farm: {counts}", counts=counts(findings))
            self.report({"WARNING"}, text)
        elif result is not None:
            self.report({"INFO"}, message("The file renders the same without the extension"))
        else:
            self.report({"INFO"}, message("The file is ready for a farm"))
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_check_farm,)


def register() -> None:
    """Start without findings."""
    _last.clear()


def unregister() -> None:
    """Drop the findings."""
    _last.clear()
