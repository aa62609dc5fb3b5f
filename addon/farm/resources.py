# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks what our materials need from outside their node group: files, libraries, scripts."""

import os
from collections.abc import Iterable

import bpy

from ..core.finding import Finding
from ..scene.image_files import first_file, image_subject, images_in, is_outside, missing_image
from ..scene.usage import Use

# A big scene has hundreds.
_MOST_LISTED = 5
# Kinds of data-blocks whose content may be a file.
_WITH_FILES = ("images", "movieclips", "sounds", "fonts", "volumes", "cache_files")
_PACK_LIBRARIES = "Take File > External Data > Pack Linked Libraries, or make it all local."
_PUT_BACK = "Put it back, load this file again, and take External Data > Pack Linked Libraries."
_BRING_BACK = "Bring that back in the library, or remove what uses it here."


def image_findings(uses: Iterable[Use]) -> list[Finding]:
    """Return which images of used materials lie outside the file."""
    found = []
    for image, material in images_in(uses).items():
        missing = missing_image(image, material)
        if missing is not None:
            found.append(missing)
            continue
        if image.is_dirty:
            message = "It has been painted on and not saved."
        elif is_outside(image):
            message = f"It is the file {image.filepath}, outside this one."
        else:
            continue
        remedy = "Pack it: File > External Data."
        found.append(Finding("warning", image_subject(image, material), message, remedy))
    return found


def node_file_findings(uses: Iterable[Use]) -> list[Finding]:
    """Return which scripts and IES profiles of used materials, lights and worlds are files."""
    owners = {tree: use.material for use in uses for tree in use.trees}
    for owner in (*bpy.data.lights, *bpy.data.worlds):
        if owner.users and owner.node_tree is not None:
            owners[owner.node_tree] = owner
    found = []
    for tree, owner in owners.items():
        for node in tree.nodes:
            if getattr(node, "mode", "") != "EXTERNAL" or not node.filepath:
                continue
            here = os.path.exists(bpy.path.abspath(node.filepath, library=tree.library))
            where = "outside this one" if here else "which is missing"
            subject = f"Node '{node.name}' of '{owner.name}'"
            message = f"It reads the file {node.filepath}, {where}."
            found.append(Finding("warning", subject, message, "Set the node to Internal."))
    return found


def library_findings() -> list[Finding]:
    """Return which libraries the file needs that are not packed into it, the missing ones first.

    All libraries count, because nobody knows whether the data of a missing one was ours.
    """
    errors, warnings = [], []
    for library in bpy.data.libraries:
        # Users know the data that was linked directly.
        linked = sorted(library.users_id, key=lambda data: data.is_library_indirect)
        if not linked:  # it will not be saved
            continue
        lost = [data for data in linked if data.is_missing]
        names = _listed([f"'{data.name}'" for data in lost or linked])
        subject = f"Library '{library.filepath}'"
        # Blender 5 also packs single data-blocks, into libraries that are archives.
        packed = library.packed_file or getattr(library, "is_archive", False)
        if not packed and not os.path.exists(bpy.path.abspath(library.filepath)):
            message = f"It is missing, and with it {names}."
            errors.append(Finding("error", subject, message, _PUT_BACK))
        elif lost:
            message = f"It holds no {names}, which this file needs."
            errors.append(Finding("error", subject, message, _BRING_BACK))
        elif not packed:
            message = f"A farm needs this file too, for {names}."
            warnings.append(Finding("warning", subject, message, _PACK_LIBRARIES))
    return errors + warnings


def other_file_findings(uses: Iterable[Use]) -> list[Finding]:
    """Return the files that the rest of the scene's data needs, without those of used materials."""
    told = images_in(uses)
    paths = {
        first_file(data)
        for name in _WITH_FILES
        for data in getattr(bpy.data, name)
        if data not in told and data.users and is_outside(data)
    }
    found = []
    for level, here, what, remedy in (
        ("warning", False, "files that are missing", "Put them back, or remove what uses them."),
        ("note", True, "other files", "Pack them, or send them along."),
    ):
        listed = sorted(path for path in paths if os.path.exists(path) == here)
        if listed:
            message = f"Beside these materials, the file needs {what}: {_listed(listed)}."
            found.append(Finding(level, "File", message, remedy))
    return found


def _listed(names: list[str]) -> str:
    rest = len(names) - _MOST_LISTED
    return ", ".join(names[:_MOST_LISTED]) + (f" and {rest} more" if rest > 0 else "")


def script_findings(uses: Iterable[Use]) -> list[Finding]:
    """Return which drivers of used materials need Python, and which texts need the extension."""
    trees = {tree: use.material for use in uses for tree in (use.material, *use.trees, *use.groups)}
    found = []
    for tree, material in trees.items():
        for curve in tree.animation_data.drivers if tree.animation_data else ():
            driver = curve.driver
            if driver.type != "SCRIPTED" or driver.is_simple_expression:
                continue
            subject = f"Driver of material '{material.name}'"
            message = f"{driver.expression!r} is Python, which a farm may not run by itself."
            remedy = "Use a simple expression, or let the farm run scripts (--enable-autoexec)."
            found.append(Finding("warning", subject, message, remedy))
    for text in bpy.data.texts:
        if text.use_module and "microbounce" in text.as_string().lower():
            subject = f"Text '{text.name}'"
            message = "It is run when the file is loaded and names the extension."
            remedy = "Switch Text > Register off, unless it works without."
            found.append(Finding("warning", subject, message, remedy))
    return found
