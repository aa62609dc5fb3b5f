# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles the shaders of all our groups in the file again, to compare with what they carry."""

import bpy

from ..core.kinds import kind_named
from ..core.shader_source import inlined_source
from ..material.graph import KIND_KEY
from ..material.group import script_node
from ..material.script import compile_source, set_bytecode


def compile_anew() -> None:
    """Give every group of ours the bytecode of its own source, or of today's if that is gone.

    Raises ValueError for a group of an unknown kind and what compile_source() raises.
    """
    for group in bpy.data.node_groups:
        script = script_node(group) if KIND_KEY in group else None
        if script is None:
            continue
        text = script.script
        kind = kind_named(group[KIND_KEY])
        source = text.as_string() if text is not None else inlined_source(kind.shader)
        set_bytecode(script, compile_source(source))
