# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks on demand whether the file renders on a farm, without the extension, as it does here."""

from pathlib import Path

import bpy

from ..core.finding import Finding, by_level, counts, worst
from ..ui.text import message

_PROVE = "Also render the saved file small, with and without the extension, and compare"

# What the check of a scene found last, by the scene's number in this session.
_last: dict[int, tuple[Finding, ...]] = {}


def last_findings(scene: bpy.types.Scene) -> tuple[Finding, ...] | None:
    """Return what the last check of `scene` found, None where there was none."""
    return _last.get(scene.session_uid)


class MICROBOUNCE_OT_check_farm(bpy.types.Operator):
    """Report what may make our materials render differently without the extension."""

    bl_idname = "microbounce.check_farm"
    bl_label = "Check for Farm"
    bl_description = (
        "Report what may make the Microbounce materials of this file render differently on a "
        "computer without the extension. Nothing is changed"
    )
    bl_options = {"REGISTER"}

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

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Check, keep the findings for the panel, and report how many there are."""
        # Imported when it is used: a start of Blender pays nothing for it.
        from ..nodes.farm.check import farm_findings
        from ..nodes.farm.proof import ProofError

        findings = farm_findings(context.scene)
        if self.prove:
            try:
                findings += self._proof(context)
            except ProofError as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
        _last[context.scene.session_uid] = by_level(findings)
        if worst(findings) in ("error", "warning"):
            text = message("For a farm, {counts} were found", counts=counts(findings))
            self.report({"WARNING"}, text)
        elif self.prove:
            self.report({"INFO"}, message("The file renders the same without the extension"))
        else:
            self.report({"INFO"}, message("The file is ready for a farm"))
        return {"FINISHED"}

    def _proof(self, context: bpy.types.Context) -> list[Finding]:
        from ..nodes.farm.proof import ProofError, prove

        # Without a window Blender does not keep track of changes.
        changed = bpy.data.is_dirty and not bpy.app.background
        if not bpy.data.is_saved or changed:
            raise ProofError(message("The proof renders the file as it is saved: save it first"))
        path = Path(bpy.data.filepath)
        manager = context.window_manager
        manager.progress_begin(0, 2)
        steps = iter(range(2))
        try:
            proof = prove(path, tell=lambda text: manager.progress_update(next(steps)))
        finally:
            manager.progress_end()
        return proof.findings(path)


CLASSES = (MICROBOUNCE_OT_check_farm,)


def register() -> None:
    """Begin without findings."""
    _last.clear()


def unregister() -> None:
    """Drop what was found."""
    _last.clear()
