# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse BSDF: its Roughness is Oren and Nayar's, which flattens the shading sooner than ours."""

from ..fallback import MATTE_ROUGHNESS
from .bounces import note_isotropic, note_model
from .state import State
from .translation import Family, Translation, need_fixed

# Our Roughness nearest to Oren and Nayar's sigma is 0.8 sigma^0.3: spheres of albedo 0.4 and 0.8
# under suns from three sides are then 2, 2, 3, 7 and 17 % (L2) apart at most, for sigma 0.05, 0.1,
# 0.25, 0.5 and 1. The way back is not the inverse but the fallback's factor, since ours goes where
# Oren and Nayar's model does not.
_FACTOR, _POWER = 0.8, 0.3


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
    made.derive(native, name, "Roughness", nearest_roughness)
    if native.values[name] > 0.0:
        made.notes.append(
            f"{name} {native.values[name]:.3g} is Oren and Nayar's: ours is "
            f"{made.values['Roughness']:.3g}, which looks nearest"
        )


def nearest_roughness(sigma: float) -> float:
    """Return our Roughness that looks nearest to Oren and Nayar's `sigma`, cut to 0 to 1."""
    return _FACTOR * max(0.0, min(1.0, sigma)) ** _POWER


def matte_roughness_to_native(ours: State, name: str, made: Translation) -> None:
    """Set Oren and Nayar's roughness, the input `name`, from ours, and note what differs.

    Raises NotConvertibleError where ours is linked or animated.
    """
    need_fixed(ours, "Roughness", "its values would need a formula")
    made.derive(ours, "Roughness", name, lambda roughness: roughness * MATTE_ROUGHNESS)
    if ours.values["Roughness"] > 0.0:
        made.notes.append("Oren and Nayar's model stands for ours, which looks nearest")
        note_isotropic(ours, made, "Oren and Nayar's model")
    note_model(ours, made)


DIFFUSE = Family("ShaderNodeBsdfDiffuse", _forward, _back)
