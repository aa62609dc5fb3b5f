# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds editors in Blender's window, waits for drawing, and presses keys. Runs in Blender."""

from collections.abc import Iterator

import bpy

from .session import NODES, VIEW

# Seconds that Blender gets to draw a change.
DRAW = 1.0


def window() -> bpy.types.Window:
    """Return Blender's only window, which a timer's context lacks."""
    return bpy.context.window_manager.windows[0]


def area(ui_type: str) -> bpy.types.Area:
    """Return the largest editor of a type on the screen."""
    found = [area for area in window().screen.areas if area.ui_type == ui_type]
    return max(found, key=lambda area: area.width * area.height)


def in_area(ui_type: str) -> object:
    """Return a context manager that shows operators the main region of area(ui_type)."""
    found = area(ui_type)
    region = next(region for region in found.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window(), area=found, region=region)


def drawn() -> Iterator[float]:
    """Wait until Blender has drawn and rendered its previews. Earlier changes may hang it."""
    yield DRAW
    while bpy.app.is_job_running("RENDER_PREVIEW"):
        yield DRAW


def workspace(name: str) -> Iterator[float]:
    """Go to a workspace of Blender's start-up file, in Object Mode.

    In Edit Mode, Blender would undo only changes of the mesh.
    """
    bpy.data.workspaces[name].object_mode = "OBJECT"
    window().workspace = bpy.data.workspaces[name]
    yield from drawn()


def show_nodes() -> Iterator[float]:
    """Turn the largest 3D view into a Shader editor with our sidebar tab open."""
    area(VIEW).ui_type = NODES
    area(NODES).spaces.active.show_region_ui = True
    yield from drawn()  # only then the sidebar has tabs
    sidebar = next(region for region in area(NODES).regions if region.type == "UI")
    sidebar.active_panel_category = "Microbounce"
    yield from drawn()
    with in_area(NODES):
        bpy.ops.node.view_all()
    yield from drawn()


def scroll_down(ui_type: str, steps: int) -> Iterator[float]:
    """Scroll an editor's main region."""
    with in_area(ui_type):
        for _ in range(steps):
            bpy.ops.view2d.scroll_down(deltay=-40)
    yield from drawn()


def point(ui_type: str) -> None:
    """Move the pointer to the middle of an editor. Needs --enable-event-simulate."""
    found = area(ui_type)
    x, y = found.x + found.width // 2, found.y + found.height // 2
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)


def press(key: str, text: str = "", ctrl: bool = False) -> None:
    """Press and release a key that writes `text`."""
    window().event_simulate(type=key, value="PRESS", unicode=text or None, ctrl=ctrl)
    window().event_simulate(type=key, value="RELEASE", ctrl=ctrl)


def write(word: str) -> None:
    """Press the keys of a word of plain letters."""
    for letter in word:
        press(letter.upper(), letter.lower())
