# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the extension's asset library to the preferences when asked, and takes it out again."""

from functools import lru_cache
from pathlib import Path

import bpy

from ..preferences import preferences
from .polled import Polled

NAME = "Microbounce"
BLEND = "microbounce.blend"


# It lies in the package of the installed extension, and in `build` of the repository.
_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDERS = (_PACKAGE / "assets", _PACKAGE.parent / "build" / "assets")


def library_folder(context: bpy.types.Context) -> Path | None:
    """Return the folder of the asset library: the one in the preferences, else the extension's own.

    None if there is no library in it.
    """
    return _look(context)[0]


def registered_libraries(context: bpy.types.Context) -> list[bpy.types.UserAssetLibrary]:
    """Return Blender's asset libraries that are ours: in a folder of ours, or with our file."""
    libraries, (_, ours) = context.preferences.filepaths.asset_libraries, _look(context)
    return [item for item in libraries if item.path in ours]


def forget_folders() -> None:
    """Look at the folders again when they are next asked for."""
    _look_at.cache_clear()


def _look(context: bpy.types.Context) -> tuple[Path | None, frozenset[str]]:
    chosen = preferences(context).library_path
    libraries = context.preferences.filepaths.asset_libraries
    return _look_at(chosen and bpy.path.abspath(chosen), tuple(item.path for item in libraries))


@lru_cache(maxsize=1)  # panels ask at every redraw, and a folder may be on a network
def _look_at(chosen: str, registered: tuple[str, ...]) -> tuple[Path | None, frozenset[str]]:
    """Return the folder of the asset library, and which of the folders `registered` are ours."""
    folders = (Path(chosen),) if chosen else _FOLDERS
    folder = next((folder for folder in folders if (folder / BLEND).is_file()), None)
    paths = [(path, Path(path).resolve()) for path in registered if path]
    ours = (path for path, real in paths if real in _FOLDERS or (real / BLEND).is_file())
    return folder, frozenset(ours)


def _missing(context: bpy.types.Context) -> str:
    chosen = preferences(context).library_path
    if chosen:
        return f"There is no {BLEND} in {chosen}: choose another folder in the preferences"
    return (
        "This copy of the extension has no asset library: install one that has, "
        "or build it with `make assets`"
    )


class MICROBOUNCE_OT_register_library(Polled, bpy.types.Operator):
    """Add the asset library to the preferences."""

    bl_idname = "microbounce.register_library"
    bl_label = "Add Microbounce Asset Library"
    bl_description = "Show the presets in the Asset Browser, as materials to drag onto objects"
    bl_options = {"REGISTER"}  # undo leaves the preferences alone

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return that there is no library, or that it was added already; else ""."""
        if library_folder(context) is None:
            return _missing(context)
        if registered_libraries(context):
            return "The asset library is in the preferences already"
        return ""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it. The user's own setting decides whether preferences are saved."""
        forget_folders()
        reason = self.why_not(context)
        if reason:  # since the panel was drawn
            self.report({"ERROR"}, reason)
            return {"CANCELLED"}
        libraries = context.preferences.filepaths.asset_libraries
        libraries.new(name=NAME, directory=str(library_folder(context)))
        context.preferences.is_dirty = True
        return {"FINISHED"}


class MICROBOUNCE_OT_unregister_library(Polled, bpy.types.Operator):
    """Take the asset library out of the preferences."""

    bl_idname = "microbounce.unregister_library"
    bl_label = "Remove Microbounce Asset Library"
    bl_description = "Take the presets out of the Asset Browser; no file is deleted"
    bl_options = {"REGISTER"}  # undo leaves the preferences alone

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return that the library was not added; "" if it was."""
        if registered_libraries(context):
            return ""
        return "The asset library is not in the preferences"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it, and no other."""
        forget_folders()
        for library in registered_libraries(context):
            context.preferences.filepaths.asset_libraries.remove(library)
        context.preferences.is_dirty = True
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_register_library, MICROBOUNCE_OT_unregister_library)


def register() -> None:
    """Look at the folders again: another version may have been installed into them."""
    forget_folders()


def unregister() -> None:
    """Drop the results."""
    forget_folders()
