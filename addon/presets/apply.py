# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives materials the values of presets and finishes."""

import bpy

from ..core.kinds import KINDS
from ..core.parameter import Value
from ..core.presets.files import Finish, Preset
from ..material.graph import node_kind
from ..material.node import (
    MaterialError,
    add_surface_node,
    material_node,
    new_material,
    set_values,
    why_not_editable,
)

# On a node: the identifier of the preset that was last applied to it.
PRESET_KEY = "microbounce_preset"

# A node made for a preset starts with these, as in the preset's picture. The group's own default
# roughness of 0.5 would frost every glass.
NEW_VALUES: dict[str, dict[str, Value]] = {
    "CONDUCTOR": {"Roughness": 0.3},
    "DIELECTRIC": {"Roughness": 0.0},
    "DIFFUSE": {},
}


def apply_preset(
    material: bpy.types.Material, preset: Preset, finish: Finish | None = None, quality: str = ""
) -> list[str]:
    """Give `material` the values of `preset`, then those of `finish`; return the labels left out.

    A linked input is left out. If no node of the preset's kind feeds the output, a new one of this
    `quality` is linked to it ("" for the default). The nodes that were there stay, unlinked.
    Raises MaterialError if the material cannot change or the finish is for other kinds, and what
    material_group() raises.
    """
    _check_finish(preset, finish)
    reason = why_not_editable(material)
    if reason:
        raise MaterialError(reason)
    node = material_node(material, preset.kind)
    if node is None:
        node = add_surface_node(material, preset.kind, _start(preset.kind, quality))
    elif bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return _set(node, preset, finish)


def preset_material(
    preset: Preset, finish: Finish | None = None, quality: str = ""
) -> bpy.types.Material:
    """Return a new material named after `preset`, with its values and those of `finish`.

    Raises what apply_preset() raises; no material is left behind then.
    """
    _check_finish(preset, finish)
    material = new_material(preset.kind, preset.name, **_start(preset.kind, quality))
    _set(material_node(material), preset, finish)
    return material


def apply_finish(material: bpy.types.Material, finish: Finish) -> list[str]:
    """Set the values of `finish` on the material's node; return the labels left out.

    Raises MaterialError if the material cannot change or has no node that takes the finish.
    """
    reason = why_not_editable(material)
    if reason:
        raise MaterialError(reason)
    node = material_node(material)
    if node is None or node_kind(node) not in finish.kinds:
        raise MaterialError(
            f"The finish '{finish.name}' needs a node {_names(finish.kinds)} that feeds the output "
            f"of '{material.name}': apply a preset of that kind first"
        )
    return set_values(node, finish.values)


def _start(kind: str, quality: str) -> dict[str, Value | str]:
    return NEW_VALUES[kind] | ({"Quality": quality} if quality else {})


def _set(node: bpy.types.Node, preset: Preset, finish: Finish | None) -> list[str]:
    left = set_values(node, {**preset.values, **(finish.values if finish else {})})
    node[PRESET_KEY] = preset.identifier
    return left


def _check_finish(preset: Preset, finish: Finish | None) -> None:
    if finish is not None and preset.kind not in finish.kinds:
        raise MaterialError(
            f"The finish '{finish.name}' is for {_names(finish.kinds)}, and '{preset.name}' is "
            f"{KINDS[preset.kind].name}: choose another finish"
        )


def _names(kinds: tuple[str, ...]) -> str:
    return ", ".join(KINDS[kind].name for kind in kinds)
