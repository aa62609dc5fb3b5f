# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws our panels again; Blender does so by itself only if a button was pressed."""

import bpy

_EDITORS = ("PROPERTIES", "NODE_EDITOR")


def redraw_panels(context: bpy.types.Context) -> None:
    """Draw again the editors that have panels of ours."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in _EDITORS:
                area.tag_redraw()
