# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets' pictures, loaded as icons when they are first drawn."""

from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "previews"

# Blender's collection of the icons, made with the first of them.
_icons = None


def picture_path(identifier: str) -> Path:
    """Return where the picture of a preset lies, such as that of "conductor/gold"."""
    return FOLDER / f"{identifier.replace('/', '-')}.webp"


def icon(identifier: str) -> int:
    """Return the icon of a preset's picture; 0, which is none if there is no picture."""
    global _icons
    import bpy.utils.previews

    if _icons is None:
        _icons = bpy.utils.previews.new()
    if identifier not in _icons:
        path = picture_path(identifier)
        if not path.is_file():
            return 0
        _icons.load(identifier, str(path), "IMAGE")
    return _icons[identifier].icon_id


def release() -> None:
    """Take the icons out of memory."""
    global _icons
    import bpy.utils.previews

    if _icons is not None:
        bpy.utils.previews.remove(_icons)
        _icons = None
