# SPDX-License-Identifier: GPL-3.0-or-later
"""Principled BSDF if it is a metal, a glass or a matte surface and nothing besides."""

from .bounces import distribution_to_native, distribution_to_ours, note_isotropic
from .diffuse import matte_roughness_to_native, matte_roughness_to_ours
from .formula import Formula, Operation
from .state import State
from .translation import Family, NotConvertibleError, Translation, need_value

# Light that passes through both sides of a glass takes the base colour.
_ROOT = Formula((Operation("GAMMA", 0.5),))
_SQUARE = Formula((Operation("GAMMA", 2.0),))

_BLACK = [0.0, 0.0, 0.0, 1.0]
_WHITE = [1.0, 1.0, 1.0, 1.0]


def _forward(native: State) -> Translation:
    return _TO_OURS[_kind(native)](native)


def _kind(native: State) -> str:
    """Return the kind of ours that it is. Raises NotConvertibleError if it is none."""
    need_value(native, "Alpha", "Microbounce has no transparency", 1.0)
    if not native.is_fixed("Emission Color", _BLACK):
        need_value(native, "Emission Strength", "Microbounce has no emission", 0.0)
    for name, thing in (
        ("Coat Weight", "coat"),
        ("Sheen Weight", "sheen"),
        ("Thin Film Thickness", "thin film"),
    ):
        need_value(native, name, f"Microbounce has no {thing}", 0.0)
    mixed = "Microbounce has metal, glass and matte surfaces, but no mixtures in one node"
    need_value(native, "Metallic", mixed, 1.0, 0.0)
    if native.values["Metallic"] == 1.0:
        return "CONDUCTOR"
    need_value(native, "Thin Wall", "Microbounce has no thin walls", False)
    need_value(native, "Transmission Weight", mixed, 1.0, 0.0)
    if native.values["Transmission Weight"] == 1.0:
        return "DIELECTRIC"
    need_value(native, "Subsurface Weight", "Microbounce has no subsurface scattering", 0.0)
    if native.is_fixed("Specular IOR Level", 0.0) or native.is_fixed("IOR", 1.0):
        return "DIFFUSE"
    raise NotConvertibleError(
        "It is a matte surface under a glossy one, which Microbounce does not have: set Metallic "
        "or Transmission to 1, or Specular IOR Level to 0"
    )


def _metal_to_ours(native: State) -> Translation:
    made = Translation("CONDUCTOR")
    made.carry(
        native,
        *("Base Color", "Roughness", "Normal", "Tangent"),
        Edge_Tint="Specular Tint",
        Anisotropy="Anisotropic",
        Rotation="Anisotropic Rotation",
    )
    made.values["Fresnel"] = 0
    distribution_to_ours(native, made)
    return made


def _glass_to_ours(native: State) -> Translation:
    need_value(native, "Specular Tint", "our glass tints all light alike", _WHITE)
    made = Translation("DIELECTRIC")
    made.carry(native, "Roughness", "IOR", "Normal")
    made.derive(native, "Base Color", "Color", _ROOT, undoes=_SQUARE)
    if "Base Color" in native.varying or native.values["Base Color"][:3] != _WHITE[:3]:
        made.notes.append(
            "Color is the square root of Base Color, and tints reflections too, which are white in "
            "Principled BSDF: strong colours become darker"
        )
    distribution_to_ours(native, made)
    return made


def _matte_to_ours(native: State) -> Translation:
    made = Translation("DIFFUSE")
    made.carry(native, "Normal", Color="Base Color")
    matte_roughness_to_ours(native, "Diffuse Roughness", made)
    return made


_TO_OURS = {"CONDUCTOR": _metal_to_ours, "DIELECTRIC": _glass_to_ours, "DIFFUSE": _matte_to_ours}


def _back(ours: State, was: State | None) -> Translation:
    if was is None:
        raise NotConvertibleError("It was no Principled BSDF")
    made = Translation(PRINCIPLED.idname)
    _TO_NATIVE[_kind(was)](ours, made)
    if made.settings.get("distribution") == "BECKMANN":
        raise NotConvertibleError("Principled BSDF has no Beckmann distribution")
    return made


def _metal_to_native(ours: State, made: Translation) -> None:
    need_value(ours, "Fresnel", "Principled BSDF has no n and k", 0)
    made.carry(
        ours,
        *("Base Color", "Roughness", "Normal", "Tangent"),
        Specular_Tint="Edge Tint",
        Anisotropic="Anisotropy",
        Anisotropic_Rotation="Rotation",
    )
    distribution_to_native(ours, made)


def _glass_to_native(ours: State, made: Translation) -> None:
    made.carry(ours, "Roughness", "IOR", "Normal")
    made.derive(ours, "Color", "Base Color", _SQUARE, undoes=_ROOT)
    distribution_to_native(ours, made)
    note_isotropic(ours, made, "The glass of Principled BSDF")


def _matte_to_native(ours: State, made: Translation) -> None:
    made.carry(ours, "Normal", Base_Color="Color")
    matte_roughness_to_native(ours, "Diffuse Roughness", made)


_TO_NATIVE = {
    "CONDUCTOR": _metal_to_native,
    "DIELECTRIC": _glass_to_native,
    "DIFFUSE": _matte_to_native,
}


PRINCIPLED = Family("ShaderNodeBsdfPrincipled", _forward, _back)
