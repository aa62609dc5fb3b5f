# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the check before each render and shows its findings in the console and the panels."""

import sys

import bpy
from bpy.app.handlers import persistent

from ..scene import before_render

# Raised while reading file data that is not as expected.
_ERRORS = (
    AttributeError,
    LookupError,
    OSError,
    ReferenceError,
    RuntimeError,
    TypeError,
    ValueError,
)


@persistent
def check_before_render(scene: bpy.types.Scene, *_: object) -> None:
    """Print the findings, once until they change. The render goes on in any case."""
    try:
        findings = before_render.check_scene(scene, bpy.context.preferences)
        if findings is None:
            before_render.forget(scene)
        elif before_render.remember(scene, findings):
            for finding in findings:
                print(f"Microbounce: {finding.as_text()}")
    except _ERRORS as error:
        reason = f"{type(error).__name__}: {error}"
        print(f"Microbounce: the check before rendering failed ({reason})", file=sys.stderr)


def register() -> None:
    """Check before renders."""
    bpy.app.handlers.render_init.append(check_before_render)


def unregister() -> None:
    """Stop checking, and drop the findings."""
    bpy.app.handlers.render_init.remove(check_before_render)
    before_render.forget_all()
