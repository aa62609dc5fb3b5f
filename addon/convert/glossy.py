# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy BSDF: it reflects the same at every angle, and its anisotropy differs from our metal's.

Its alphas are r^2 / (1 + a) and r^2 (1 + a) for an anisotropy a below 0, and swapped for one above
0. Ours are r^2 / s and r^2 s with s = sqrt(1 - 0.9 A).
"""

import math

from .bounces import distribution_to_native, distribution_to_ours
from .formula import Formula, Operation
from .state import State
from .translation import Family, NotConvertibleError, Translation, need_fixed, need_value

# Rough along the other direction, a quarter turn away.
_QUARTER_MORE = Formula((Operation("ADD", 0.25), Operation("FRACT")))
_QUARTER_LESS = Formula((Operation("ADD", -0.25), Operation("FRACT")))

# The smallest s, at A = 1.
_SHORTEST = math.sqrt(1.0 - 0.9)

# F82 reflects F(c) = f + (1 - f) (1 - c)^5 - b c (1 - c)^6 at a cosine c. b makes F(1/7) the tint
# times its value without b. The mean is f + (1 - f) / 21 - b / 126.
_COSINE = 1.0 / 7.0

# If the colour is a texture, the tint is that of this reflectance.
_TYPICAL = 0.8


def _forward(native: State) -> Translation:
    made = Translation("CONDUCTOR")
    made.carry(native, "Roughness", "Normal", "Tangent", Base_Color="Color")
    made.values["Fresnel"] = 0
    if "Color" in native.varying:
        made.values["Edge Tint"] = [edge_tint(_TYPICAL)] * 3 + [1.0]
        made.notes.append(
            "Glossy BSDF reflects the same at every angle; Color is linked or animated, so Edge "
            f"Tint suits a reflectance of {_TYPICAL:g}, and dark colours become up to 0.05 brighter"
        )
    else:
        color = native.values["Color"][:3]
        made.values["Edge Tint"] = [*map(edge_tint, color), 1.0]
        if any(c < 1.0 for c in color):
            made.notes.append(
                "Glossy BSDF reflects the same at every angle: Edge Tint keeps its mean, and the "
                "rim becomes whiter"
            )
    _anisotropy_to_ours(native, made)
    distribution_to_ours(native, made)
    return made


def edge_tint(reflectance: float) -> float:
    """Return the F82 tint whose reflectance has the mean `reflectance`, that straight on.

    Both are from 0 to 1. A reflectance outside counts as the closer end.
    """
    f = max(0.0, min(1.0, reflectance))
    schlick = f + (1.0 - f) * (1.0 - _COSINE) ** 5
    b = 6.0 * (1.0 - f)
    return 1.0 - b * _COSINE * (1.0 - _COSINE) ** 6 / schlick


def _anisotropy_to_ours(native: State, made: Translation) -> None:
    # Nodes could convert its size, but its sign also turns Rotation.
    need_fixed(native, "Anisotropy", "its sign decides on our Rotation too")
    a = min(max(native.values["Anisotropy"], -0.99), 0.99)
    if a > 0.0:
        made.derive(native, "Rotation", "Rotation", _QUARTER_MORE, undoes=_QUARTER_LESS)
    else:
        made.carry(native, "Rotation")
    s = 1.0 - abs(a)
    made.values["Anisotropy"] = min(1.0, (1.0 - s * s) / 0.9)
    if s < _SHORTEST:
        made.notes.append(
            f"Anisotropy {a:.3g} is stronger than ours can be, as from {1 - _SHORTEST:.3f}"
        )


def _back(ours: State, was: State | None) -> Translation:
    need_value(ours, "Fresnel", "Glossy BSDF has no Fresnel reflection", 0)
    if "Edge Tint" in ours.varying:
        raise NotConvertibleError("Edge Tint is linked or animated: Glossy BSDF has none")
    made = Translation(GLOSSY.idname)
    made.carry(ours, "Roughness", "Normal", "Tangent", Color="Base Color")
    across = was is not None and was.values["Anisotropy"] > 0.0
    need_fixed(ours, "Anisotropy", "that of Glossy BSDF means something else")
    made.values["Anisotropy"] = _to_glossy(ours.values["Anisotropy"], across)
    if across:
        made.derive(ours, "Rotation", "Rotation", _QUARTER_LESS, undoes=_QUARTER_MORE)
    else:
        made.carry(ours, "Rotation")
    made.notes.append("Glossy BSDF reflects the same at every angle: it has no Edge Tint")
    distribution_to_native(ours, made)
    return made


def _to_glossy(strength: float, across: bool) -> float:
    s = math.sqrt(1.0 - 0.9 * strength)
    return 1.0 - s if across else s - 1.0


GLOSSY = Family("ShaderNodeBsdfAnisotropic", _forward, _back)
