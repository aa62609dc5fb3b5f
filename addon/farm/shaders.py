# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that a node group carries its shader: the source, and the bytecode of that source."""

from dataclasses import replace
from functools import lru_cache

import bpy

from ..core.finding import Finding
from ..core.kinds import KINDS
from ..core.oso import same_program
from ..core.shader_source import ShaderSourceError, inlined_source
from ..material.graph import KIND_KEY
from ..material.group import script_node
from ..material.script import OslUnavailableError, ShaderCompileError, compile_source
from ..material.versions import is_newer, is_of_another_version

# A file has few sources, and several files in a row share them.
_compiled = lru_cache(maxsize=8)(compile_source)

_UPDATE = "Use Update Materials to give it today's shader."
_UPGRADE = "Install that newer version to change it."
_COMPILE = "Press the update button of the script node in the group."
_COMPLETE = "Add a Microbounce material of this kind once more, which completes the group."
_REPLACE = "Add a material of the same kind, and use its node group instead."
_IN_LIBRARY = "Open the library file, check that, mend it there and save it."


def shader_findings(group: bpy.types.ShaderNodeTree) -> list[Finding]:
    """Return what is wrong with one of our groups by itself."""
    subject = f"Node group '{group.name}'"
    kind = KINDS.get(group[KIND_KEY])
    if kind is None:
        return [
            Finding(
                "warning",
                subject,
                f"It is of the kind {group[KIND_KEY]!r}, which this version does not know.",
                "Install the version of the extension that made it, and check with that.",
            )
        ]
    try:
        source = inlined_source(kind.shader)
    except ShaderSourceError as error:
        message = "The extension's own shader cannot be read, so it was not compared."
        return [Finding("warning", subject, message, f"{error}.")]
    other = is_of_another_version(group)
    found = _script_findings(group, subject, "" if other else source)
    change = _UPGRADE if is_newer(group) else _UPDATE
    elsewhere = _IN_LIBRARY if group.library else change if other else ""
    if elsewhere:
        found = [f if f.level == "note" else replace(f, remedy=elsewhere) for f in found]
    if other:
        message = "Another version of the extension made it; it renders as that version did."
        found.append(Finding("note", subject, message, elsewhere))
    return found


def _script_findings(
    group: bpy.types.ShaderNodeTree, subject: str, known_source: str
) -> list[Finding]:
    """Check the script node; `known_source` is what its text should hold, "" if unknown."""
    script = script_node(group)
    if script is None:
        message = "Its script node is gone; Cycles' own material shows."
        return [Finding("error", subject, message, _REPLACE)]
    if script.mode == "EXTERNAL":
        message = f"Its shader is the file {script.filepath!r}, which a farm does not have."
        return [Finding("error", subject, message, "Set the script node to Internal.")]
    if not script.bytecode and script.bytecode_hash:
        message = "Its bytecode was taken out, but not the hash: Blender 5.2 stops on that."
        return [Finding("error", subject, message, _COMPLETE)]
    if not script.bytecode:
        message = "Its shader has no bytecode; Cycles' own material shows."
        return [Finding("error", subject, message, _COMPLETE)]
    if not script.bytecode_hash:  # Cycles goes by it
        message = "The hash of its bytecode is gone; Cycles' own material shows."
        return [Finding("error", subject, message, _COMPILE)]
    found = []
    text = script.script
    if text is None:
        message = "Its shader's source is gone; what is compiled still renders."
        found.append(Finding("warning", subject, message, _COMPLETE))
        source = known_source
    else:
        source = text.as_string()
        if text.filepath and not text.is_in_memory:
            message = f"Its shader's source is the file {text.filepath!r}, outside this one."
            remedy = "Take Text > Make Internal in the Text editor."
            found.append(Finding("warning", subject, message, remedy))
    if source:
        found += _bytecode_findings(subject, source, script.bytecode)
    return found


def _bytecode_findings(subject: str, source: str, bytecode: str) -> list[Finding]:
    try:
        expected = _compiled(source)
    except OslUnavailableError:
        message = "This Blender has no Open Shading Language, so its bytecode was not compared."
        return [Finding("note", subject, message, "Check in a Blender from blender.org.")]
    except ShaderCompileError as error:
        return [Finding("error", subject, f"{error}.", _COMPILE)]
    if same_program(bytecode, expected):
        return []
    message = "Its bytecode is not what its source gives."
    return [Finding("error", subject, message, _COMPILE)]
