# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse BSDF: its Roughness is Oren and Nayar's, which flattens the shading sooner than ours."""

from ..fallback import MATTE_ROUGHNESS
from .bounces import note_isotropic, note_model
from .state import State
from .translation import Family, Translation, need_fixed


def _forward(native: State) -> Translation:
    made = Translation("DIFFUSE")
    made.carry(native, "Color", "Normal")
    matte_roughness_to_ours(native, "Roughness", made)
    return made


def _back(ours: State, was: State | None) -> Translation:
    made = Translation(DIFFUSE.idname)
    made.carry(ours, "Color", "Normal")
    matte_roughness_to_native(ours, "Roughness", made)
    return made


def matte_roughness_to_ours(native: State, name: str, made: Translation) -> None:
    """Set Roughness from Oren and Nayar's, the input `name`; 0 is Lambert's surface on both.

    Raises NotConvertibleError where it is linked or animated.
    """
    made.derive(native, name, "Roughness", lambda sigma: min(1.0, sigma / MATTE_ROUGHNESS))
    sigma = native.values[name]
    if sigma > MATTE_ROUGHNESS:
        made.notes.append(
            f"{name} {sigma:.3g} is Oren and Nayar's: above {MATTE_ROUGHNESS:g} ours stays at 1, "
            "and the shading is less flat"
        )
    elif sigma > 0.0:
        made.notes.append(
            f"{name} {sigma:.3g} is Oren and Nayar's: ours is "
            f"{made.values['Roughness']:.3g}, the nearest in brightness"
        )


def matte_roughness_to_native(ours: State, name: str, made: Translation) -> None:
    """Set Oren and Nayar's roughness, the input `name`, from ours, and note what differs.

    Raises NotConvertibleError where ours is linked or animated.
    """
    need_fixed(ours, "Roughness", "its values would need a formula")
    made.derive(ours, "Roughness", name, lambda roughness: roughness * MATTE_ROUGHNESS)
    if ours.values["Roughness"] > 0.0:
        made.notes.append("Oren and Nayar's model stands for ours, the nearest in brightness")
        note_isotropic(ours, made, "Oren and Nayar's model")
    note_model(ours, made)


DIFFUSE = Family("ShaderNodeBsdfDiffuse", _forward, _back)
