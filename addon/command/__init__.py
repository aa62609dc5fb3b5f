# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `blender --command microbounce`; `main.py` has the list of what it can do."""

import bpy

_handle: object = None


def _run(argv: list[str]) -> int:
    # Imported when the command is used: a start of Blender pays nothing for it.
    from .main import main

    return main(argv)


def register() -> None:
    """Make the command known to Blender."""
    global _handle
    _handle = bpy.utils.register_cli_command("microbounce", _run)


def unregister() -> None:
    """Take it back."""
    global _handle
    bpy.utils.unregister_cli_command(_handle)
    _handle = None
