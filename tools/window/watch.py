# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes which panels of an extension are drawn, and their errors. Runs in Blender."""

import sys
import traceback

import bpy


def watch_panels(module: str, drawn: list[str], errors: list[str], opened: bool) -> list[str]:
    """Register the panels of `module` again so that they note what they do; return their names.

    drawn, errors -- get the names of drawn panels, and the tracebacks of failed ones
    opened -- whether panels that start closed are open in screens that Blender shows later
    """
    parts = sys.modules[f"{module}.registration"]._MODULES
    found = [cls for part in parts for cls in getattr(part, "CLASSES", ())]
    classes = [cls for cls in found if issubclass(cls, bpy.types.Panel)]
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
    for cls in classes:
        if opened:
            cls.bl_options = set(getattr(cls, "bl_options", ())) - {"DEFAULT_CLOSED"}
        cls.draw = _watched(cls.__name__, cls.draw, drawn, errors)
        bpy.utils.register_class(cls)
    return sorted(cls.__name__ for cls in classes)


def _watched(name: str, draw: object, drawn: list[str], errors: list[str]) -> object:
    def watched(self: object, context: bpy.types.Context) -> None:
        try:
            draw(self, context)
        except Exception:
            errors.append(f"{name}: {traceback.format_exc()}")
            raise
        if name not in drawn:
            drawn.append(name)

    return watched
