# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's preferences."""

from dataclasses import dataclass

import bpy

from .core.analysis.picture_error import DEFAULT_TOLERANCE
from .core.parameters import SHARED

# The extension's package, under which Blender keeps its preferences; in tests it is "addon".
_PACKAGE = __package__

# One for all kinds of material.
_QUALITY = SHARED["Quality"]
_DEFAULT_QUALITY = _QUALITY.choices[_QUALITY.default]


@dataclass(frozen=True)
class Preferences:
    """The preferences' values.

    quality      -- of new nodes: a name among the choices of the parameter Quality
    tolerance    -- the error of the picture that the analysis accepts, 0 to 1
    library_path -- the folder of the asset library, "" for the one in the extension
    """

    quality: str = _DEFAULT_QUALITY
    tolerance: float = DEFAULT_TOLERANCE
    library_path: str = ""


def preferences(context: bpy.types.Context) -> Preferences:
    """Return the preferences; the defaults where Blender keeps none for the extension."""
    stored = stored_preferences(context)
    if stored is None:
        return Preferences()
    return Preferences(stored.quality, stored.tolerance, stored.library_path)


def stored_preferences(context: bpy.types.Context) -> bpy.types.AddonPreferences | None:
    """Return what Blender keeps, for panels to draw; None if it keeps nothing."""
    addon = context.preferences.addons.get(_PACKAGE)
    return addon.preferences if addon is not None else None


class MicrobouncePreferences(bpy.types.AddonPreferences):
    """What new materials and the analysis start from."""

    bl_idname = _PACKAGE

    quality: bpy.props.EnumProperty(
        name="Quality",
        description="Quality of new Microbounce nodes",
        items=[(name, name, "") for name in _QUALITY.choices],
        default=_DEFAULT_QUALITY,
    )
    tolerance: bpy.props.FloatProperty(
        name="Tolerance",
        description="Relative error of the picture that the analysis accepts",
        default=DEFAULT_TOLERANCE,
        min=0.0005,
        max=1.0,
        soft_max=0.1,
        step=0.1,
        precision=4,
    )
    library_path: bpy.props.StringProperty(
        name="Asset Library",
        description="Folder of the asset library. Empty: the library in the extension",
        subtype="DIR_PATH",
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the preferences."""
        layout = self.layout
        layout.use_property_split = True
        for name in ("quality", "tolerance", "library_path"):
            layout.prop(self, name)


CLASSES = (MicrobouncePreferences,)
