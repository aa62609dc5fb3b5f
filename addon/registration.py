# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers every module's CLASSES, then what its own `register` adds, and takes out exactly that.

A module may have `CLASSES`, or a pair of functions `register` and `unregister`, or both.
"""

from collections.abc import Callable

import bpy

from . import command
from .ops import cost as cost_ops
from .ops import material, node, osl
from .ui import cost as cost_panels
from .ui import menus, panels

_MODULES = (
    osl,
    material,
    node,
    cost_ops,
    menus,
    panels,
    cost_panels,
    command,
)

# What undoes the registration, in the order in which it was done.
_undo: list[Callable[[], None]] = []


def register() -> None:
    """Register all modules; on an error, none stays registered."""
    try:
        for module in _MODULES:
            for cls in getattr(module, "CLASSES", ()):
                bpy.utils.register_class(cls)
                _undo.append(lambda cls=cls: bpy.utils.unregister_class(cls))
            if hasattr(module, "register"):
                module.register()
                _undo.append(module.unregister)
    except Exception:
        unregister()
        raise


def unregister() -> None:
    """Undo `register` in reverse order."""
    while _undo:
        _undo.pop()()
