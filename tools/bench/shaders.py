# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes plain estimators for comparison, by small changes to the source of our shaders."""

from collections.abc import Iterable

import bpy

from addon.core.kinds import kind_named
from addon.core.shader_source import inlined_source
from addon.material.group import STAMP_KEY, material_group, script_node
from addon.material.script import compile_source

# (text of our shader, its replacement) by the name of the change.
PATCHES = {
    # With a single walk, nothing is then stratified.
    "one candidate": (("#define CANDIDATES 4", "#define CANDIDATES 1"),),
    # All bounces come from one walk, as for rays the camera does not send, with Walk's kernel.
    "whole walk": (
        (
            "accuracy.quality == QUALITY_EXACT || (accuracy.quality > QUALITY_SINGLE && one_walk)",
            "accuracy.quality > QUALITY_SINGLE",
        ),
        (
            "smooth_exit(frame, surface, material, kernel, relative,",
            "smooth_exit(frame, surface, material, accuracy.kernel, KERNEL_PER_ALPHA,",
        ),
    ),
}


def replaced_source(kind: str, patches: Iterable[tuple[str, str]]) -> str:
    """The source of this kind's shader, with the first text of each pair replaced by the second.

    Raises ValueError unless the shader has each first text exactly once.
    """
    source = inlined_source(kind_named(kind).shader)
    for ours, other in patches:
        if source.count(ours) != 1:
            raise ValueError(
                f"{kind}: the shader has {ours!r} {source.count(ours)} times, not once: update the "
                "patches in tools/bench"
            )
        source = source.replace(ours, other)
    return source


def patched_source(kind: str, patch: str) -> str:
    """The source of this kind's shader with a change of PATCHES. Raises as replaced_source()."""
    return replaced_source(kind, PATCHES[patch])


def patched_group(kind: str, patch: str) -> bpy.types.ShaderNodeTree:
    """The node group of this kind with a changed shader, made once per file."""
    name = f"{kind} {patch}"
    known = bpy.data.node_groups.get(name)
    if known is not None:
        return known
    bytecode = compile_source(patched_source(kind, patch))
    group = material_group(kind).copy()
    group.name = name
    del group[STAMP_KEY]  # else it counts as the group of today's shader
    script = script_node(group)
    script.bytecode = bytecode
    script.bytecode_hash = name  # Cycles caches shaders by it
    return group
