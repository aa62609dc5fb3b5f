# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse BSDF: its Roughness is Oren and Nayar's, which flattens the shading sooner than ours."""

from ..material.fallback import MATTE_ROUGHNESS
from .bounces import note_isotropic, note_model
from .formula import Formula, Operation
from .state import State
from .translation import Family, Translation

# The Roughness of ours closest to Oren and Nayar's sigma is 0.8 sigma^0.3. Spheres of albedo 0.4
# and 0.8 under suns from three sides are then at most 2, 2, 3, 7 and 17 % (L2) apart, for sigma
# 0.05, 0.1, 0.25, 0.5 and 1. The way back takes the fallback's factor instead of the inverse,
# because ours goes further than Oren and Nayar's model.
_TO_OURS = Formula((Operation("POWER", 0.3, clamp=True), Operation("MULTIPLY", 0.8)))
_TO_NATIVE = Formula((Operation("MULTIPLY", MATTE_ROUGHNESS),))


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
    """Set Roughness from Oren and Nayar's, the input `name`; 0 is Lambert's surface on both."""
    made.derive(native, name, "Roughness", _TO_OURS, undoes=_TO_NATIVE)
    if name in native.varying:
        made.notes.append(f"{name} is Oren and Nayar's: nodes turn it into ours that looks nearest")
    elif native.values[name] > 0.0:
        made.notes.append(
            f"{name} {native.values[name]:.3g} is Oren and Nayar's: ours is "
            f"{made.values['Roughness']:.3g}, which looks nearest"
        )


def matte_roughness_to_native(ours: State, name: str, made: Translation) -> None:
    """Set Oren and Nayar's roughness, the input `name`, from ours, and note the difference."""
    made.derive(ours, "Roughness", name, _TO_NATIVE, undoes=_TO_OURS)
    if not ours.is_fixed("Roughness", 0.0):
        made.notes.append("Oren and Nayar's model stands for ours, which looks nearest")
        note_isotropic(ours, made, "Oren and Nayar's model")
    note_model(ours, made)


DIFFUSE = Family("ShaderNodeBsdfDiffuse", _forward, _back)
