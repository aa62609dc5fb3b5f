# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass BSDF: our glass has its inputs and conventions, and also an anisotropy."""

from .bounces import distribution_to_native, distribution_to_ours, note_isotropic
from .state import State
from .translation import Family, Translation, need_value

_SHARED = ("Color", "Roughness", "IOR", "Normal")


def _forward(native: State) -> Translation:
    need_value(native, "Thin Film Thickness", "Microbounce has no thin film", 0.0)
    made = Translation("DIELECTRIC")
    made.carry(native, *_SHARED)
    distribution_to_ours(native, made)
    return made


def _back(ours: State, was: State | None) -> Translation:
    made = Translation(GLASS.idname)
    made.carry(ours, *_SHARED)
    distribution_to_native(ours, made)
    note_isotropic(ours, made, "Glass BSDF")
    return made


GLASS = Family("ShaderNodeBsdfGlass", _forward, _back)
