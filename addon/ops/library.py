# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the extension's asset library to the preferences when asked, and takes it out again."""

from pathlib import Path

import bpy

NAME = "Microbounce"
BLEND = "microbounce.blend"


# Inside the installed extension it lies in the package; in the repository, in `build`.
_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDERS = (_PACKAGE / "assets", _PACKAGE.parent / "build" / "assets")


def library_folder() -> Path | None:
    """Return the folder of the asset library, None where this copy was made without it."""
    return next((folder for folder in _FOLDERS if (folder / BLEND).is_file()), None)


def registered_libraries(
    preferences: bpy.types.Preferences,
) -> list[bpy.types.UserAssetLibrary]:
    """Return the preferences' libraries that are a folder of ours, be it there or not."""
    libraries = preferences.filepaths.asset_libraries
    return [item for item in libraries if item.path and Path(item.path).resolve() in _FOLDERS]


class MICROBOUNCE_OT_register_library(bpy.types.Operator):
    """Add the asset library to the preferences."""

    bl_idname = "microbounce.register_library"
    bl_label = "Add Microbounce Asset Library"
    bl_description = "Show the presets in the Asset Browser, as materials to drag onto objects"
    bl_options = {"REGISTER"}  # undo leaves the preferences alone

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it where there is a library that was not added; say why otherwise."""
        if library_folder() is None:
            cls.poll_message_set(
                "This copy of the extension has no asset library: install one that has, "
                "or build it with `make assets`"
            )
            return False
        if registered_libraries(context.preferences):
            cls.poll_message_set("The asset library is in the preferences already")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it; saving the preferences is left to the user's own setting."""
        preferences = context.preferences
        preferences.filepaths.asset_libraries.new(name=NAME, directory=str(library_folder()))
        preferences.is_dirty = True
        return {"FINISHED"}


class MICROBOUNCE_OT_unregister_library(bpy.types.Operator):
    """Take the asset library out of the preferences."""

    bl_idname = "microbounce.unregister_library"
    bl_label = "Remove Microbounce Asset Library"
    bl_description = "Take the presets out of the Asset Browser; no file is deleted"
    bl_options = {"REGISTER"}  # undo leaves the preferences alone

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it where the library was added; say so otherwise."""
        if registered_libraries(context.preferences):
            return True
        cls.poll_message_set("The asset library is not in the preferences")
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it, and no other."""
        preferences = context.preferences
        for library in registered_libraries(preferences):
            preferences.filepaths.asset_libraries.remove(library)
        preferences.is_dirty = True
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_register_library, MICROBOUNCE_OT_unregister_library)
