# SPDX-License-Identifier: GPL-3.0-or-later
"""Redraws our panels. Blender itself does so only after a button was pressed."""

import bpy

_EDITORS = ("PROPERTIES", "NODE_EDITOR")


def redraw_panels(context: bpy.types.Context) -> None:
    """Redraw the editors that have our panels."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in _EDITORS:
                area.tag_redraw()
