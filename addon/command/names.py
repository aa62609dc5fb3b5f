# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds what the words on the command line name: materials, presets, finishes."""

from difflib import get_close_matches

import bpy

from ..core.presets.files import Finish, Preset
from .output import CommandError


def named_item(word: str, items: tuple[Preset | Finish, ...], noun: str) -> Preset | Finish:
    """Return the one item of that identifier, file name or name, in small or capital letters.

    Raises CommandError with close names if there is none, and with all matching names if
    several have the name.
    """
    found = [item for item in items if word.casefold() in _names(item)]
    if len(found) == 1:
        return found[0]
    if found:
        choices = ", ".join(item.identifier for item in found)
        raise CommandError(f"Several {noun}s are named {word!r}: use one of {choices}")
    known = [name for item in items for name in _names(item)]
    close = ", ".join(dict.fromkeys(get_close_matches(word.casefold(), known)))
    hint = f"did you mean {close}?" if close else "`presets` lists what there is"
    raise CommandError(f"There is no {noun} {word!r}: {hint}")


def _names(item: Preset | Finish) -> tuple[str, ...]:
    identifier = item.identifier.casefold()
    return identifier, identifier.rpartition("/")[2], item.name.casefold()


def named_material(name: str) -> bpy.types.Material:
    """Return the file's own material `name`, else a linked one.

    Raises CommandError with close names if there is none.
    """
    found = [material for material in bpy.data.materials if material.name == name]
    if not found:
        names = [material.name for material in bpy.data.materials]
        close = get_close_matches(name, names) or names[:5]
        hint = f"use one of {', '.join(close)}" if close else "the file has no materials"
        raise CommandError(f"There is no material {name!r}: {hint}")
    return next((material for material in found if not material.library), found[0])
