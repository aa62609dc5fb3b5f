# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain estimators for comparison, made from our shaders by small changes of their source."""

from collections.abc import Iterable

import bpy

from addon.core.kinds import kind_named
from addon.core.shader_source import inlined_source
from addon.material.group import STAMP_KEY, material_group, script_node
from addon.material.script import compile_source

# By name, what is replaced by what.
PATCHES = {
    # With a single walk the numbers of its first vertex are then plain random ones: nothing is
    # stratified.
    "one candidate": (("#define CANDIDATES 4", "#define CANDIDATES 1"),),
    # Every bounce of one walk, as where the camera does not look, but with the kernel of Walk.
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
    """The source of this kind's shader, the first text of each pair replaced by the second.

    Raises ValueError if the shader does not have just once what is to be replaced.
    """
    source = inlined_source(kind_named(kind).shader)
    for ours, other in patches:
        if source.count(ours) != 1:
            raise ValueError(
                f"{kind}: the shader has {ours!r} {source.count(ours)} times, not once: bring the "
                "patches in tools/bench up to date"
            )
        source = source.replace(ours, other)
    return source


def patched_source(kind: str, patch: str) -> str:
    """The source of this kind's shader, changed as PATCHES says; raises as `replaced_source`."""
    return replaced_source(kind, PATCHES[patch])


def patched_group(kind: str, patch: str) -> bpy.types.ShaderNodeTree:
    """The node group of this kind with a changed shader; made once a file."""
    name = f"{kind} {patch}"
    known = bpy.data.node_groups.get(name)
    if known is not None:
        return known
    bytecode = compile_source(patched_source(kind, patch))
    group = material_group(kind).copy()
    group.name = name
    del group[STAMP_KEY]  # or it would pass for the group of today's shader
    script = script_node(group)
    script.bytecode = bytecode
    script.bytecode_hash = name  # Cycles keeps shaders by it
    return group
