# SPDX-License-Identifier: GPL-3.0-or-later
"""The conductor by itself, for code that makes no other kind."""

import bpy

from .group import new_material


def conductor_material(name: str, **values: object) -> bpy.types.Material:
    """Return a new metal, as `new_material` does."""
    return new_material("CONDUCTOR", name, **values)
