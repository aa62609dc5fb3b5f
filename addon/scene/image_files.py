# SPDX-License-Identifier: GPL-3.0-or-later
"""The images that materials read, and their files."""

import os
from collections.abc import Iterable

import bpy

from ..core.finding import Finding
from .usage import Use

_FILE_SOURCES = ("FILE", "SEQUENCE", "TILED", "MOVIE")


def images_in(uses: Iterable[Use]) -> dict[bpy.types.Image, bpy.types.Material]:
    """Return the images of nodes that are linked and not muted, each with a material of it."""
    return {
        node.image: use.material
        for use in uses
        for tree in use.trees
        for node in tree.nodes
        if getattr(node, "image", None) is not None
        and not node.mute
        and any(socket.is_linked for socket in node.outputs)
    }


def missing_image(image: bpy.types.Image, material: bpy.types.Material) -> Finding | None:
    """Return the finding that an image file of `material` is missing, None if it is there."""
    if image.is_dirty or not is_outside(image) or os.path.exists(first_file(image)):
        return None
    message = f"Its file {image.filepath} is missing."
    remedy = "Put the file back, and pack it: File > External Data."
    return Finding("warning", image_subject(image, material), message, remedy)


def image_subject(image: bpy.types.Image, material: bpy.types.Material) -> str:
    """Return the name that findings use for an image of `material`."""
    return f"Image '{image.name}' of material '{material.name}'"


def is_outside(data: bpy.types.ID) -> bool:
    """Return whether an image, a sound or the like lies in a file and is not packed."""
    if getattr(data, "packed_file", None) or not data.filepath or data.filepath == "<builtin>":
        return False
    return getattr(data, "source", "FILE") in _FILE_SOURCES and not getattr(
        data, "packed_files", None
    )


def first_file(data: bpy.types.ID) -> str:
    """Return the path of its file, or of its first tile."""
    path = bpy.path.abspath(data.filepath, library=data.library)
    if getattr(data, "source", "") == "TILED":
        return path.replace("<UDIM>", str(data.tiles[0].number))
    return path
