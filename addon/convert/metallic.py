# SPDX-License-Identifier: GPL-3.0-or-later
"""Metallic BSDF: our metal has its inputs and conventions."""

from .bounces import distribution_to_native, distribution_to_ours
from .state import State
from .translation import Family, Translation, need_fixed, need_value

_SHARED = (
    *("Base Color", "Edge Tint", "IOR", "Extinction"),
    *("Roughness", "Anisotropy", "Rotation", "Normal", "Tangent"),
)
# In the order of our numbers for Fresnel.
_FRESNEL = ("F82", "PHYSICAL_CONDUCTOR")


def _forward(native: State) -> Translation:
    need_value(native, "Thin Film Thickness", "Microbounce has no thin film", 0.0)
    made = Translation("CONDUCTOR")
    made.carry(native, *_SHARED)
    made.values["Fresnel"] = _FRESNEL.index(native.settings["fresnel_type"])
    distribution_to_ours(native, made)
    return made


def _back(ours: State, was: State | None) -> Translation:
    need_fixed(ours, "Fresnel", "the native node's choice takes no link")
    made = Translation(METALLIC.idname)
    made.carry(ours, *_SHARED)
    made.settings["fresnel_type"] = _FRESNEL[ours.values["Fresnel"]]
    distribution_to_native(ours, made)
    return made


METALLIC = Family("ShaderNodeBsdfMetallic", _forward, _back)
