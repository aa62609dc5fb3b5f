# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers every module's CLASSES, then what its own `register` adds, and takes out exactly that.

A module may have `CLASSES`, or a pair of functions `register` and `unregister`, or both.
"""

from collections.abc import Callable

import bpy

from . import command, preferences
from .operators import (
    analyse,
    check,
    choices,
    convert,
    cost,
    farm,
    library,
    material,
    node,
    osl,
    presets,
    update,
    user_presets,
)
from .ui import analyse as analysis_panels
from .ui import check as check_panels
from .ui import choices as choice_menus
from .ui import convert as convert_panel
from .ui import cost as cost_panels
from .ui import farm as farm_panels
from .ui import handlers, menus, panels
from .ui import presets as preset_panels

_MODULES = (
    osl,
    material,
    node,
    presets,
    user_presets,
    choices,
    library,
    convert,
    update,
    check,
    farm,
    analyse,
    cost,
    preferences,
    menus,
    choice_menus,
    panels,
    preset_panels,
    convert_panel,
    analysis_panels,
    check_panels,
    cost_panels,
    farm_panels,
    handlers,
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
