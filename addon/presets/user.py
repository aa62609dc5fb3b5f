# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the presets that users saved: `presets/microbounce/<kind>` in Blender's own folders."""

from pathlib import Path

import bpy

from ..core.kinds import KINDS
from ..core.presets.files import Preset, PresetError
from ..core.presets.user_files import SUFFIX, load


def user_presets(kind: str) -> list[Path]:
    """Return the files of the users' presets of a kind, by name."""
    folders = bpy.utils.preset_paths(f"microbounce/{kind.lower()}")
    found = [path for folder in folders for path in Path(folder).glob(f"*{SUFFIX}")]
    return sorted(found, key=lambda path: path.name.casefold())


def load_user_presets() -> tuple[list[Preset], list[str]]:
    """Return the users' presets of all kinds, and what is wrong with those that are left out."""
    items, problems = [], []
    for path in (path for kind in KINDS for path in user_presets(kind)):
        try:
            items.append(load(path))
        except PresetError as error:
            problems.append(str(error))
    return items, problems
