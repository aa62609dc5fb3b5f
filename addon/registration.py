# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers every module's CLASSES and menu entries, and takes exactly those out again."""

import bpy

from .ops import material, node, osl
from .ui import menus, panels

_MODULES = (osl, material, node, menus, panels)
_CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)


def register() -> None:
    """Register all classes, then the menu entries; on an error, none stays registered."""
    done = []
    try:
        for cls in _CLASSES:
            bpy.utils.register_class(cls)
            done.append(cls)
        menus.register()
    except Exception:
        for cls in reversed(done):
            bpy.utils.unregister_class(cls)
        raise


def unregister() -> None:
    """Undo `register` in reverse order."""
    menus.unregister()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
