# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells which version of the extension made a node group."""

from functools import cache

import bpy

from ..core import VERSION
from ..core.kinds import KINDS
from ..core.shader_source import inlined_source
from .graph import KIND_KEY
from .group import STAMP_KEY, VERSION_KEY, group_stamp


def is_of_another_version(group: bpy.types.NodeTree) -> bool:
    """Return whether a group is ours, but not today's.

    Raises ShaderSourceError if the installation is damaged.
    """
    kind = group.get(KIND_KEY)
    return kind in KINDS and group.get(STAMP_KEY) != _todays_stamp(kind)


def is_newer(group: bpy.types.NodeTree) -> bool:
    """Return whether a newer version of the extension made a group."""
    return _numbers(str(group.get(VERSION_KEY, ""))) > _numbers(VERSION)


def forget_stamps() -> None:
    """Read the shaders' sources again when they are next asked for."""
    _todays_stamp.cache_clear()


@cache
def _todays_stamp(kind: str) -> str:
    return group_stamp(KINDS[kind], inlined_source(KINDS[kind].shader))


def _numbers(version: str) -> list[int]:
    return [int(part) for part in version.split(".") if part.isdecimal()]
