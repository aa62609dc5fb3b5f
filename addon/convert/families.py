# SPDX-License-Identifier: GPL-3.0-or-later
"""The native nodes that have a counterpart of ours, and the closest native one of each kind."""

from dataclasses import replace

from ..core.kinds import KINDS
from ..material.sockets import socket_value
from .diffuse import DIFFUSE
from .glass import GLASS
from .glossy import GLOSSY
from .metallic import METALLIC
from .principled import PRINCIPLED
from .state import State
from .translation import NotConvertibleError, Translation

FAMILIES = {f.idname: f for f in (METALLIC, GLOSSY, GLASS, DIFFUSE, PRINCIPLED)}
NEAREST = {"CONDUCTOR": METALLIC, "DIELECTRIC": GLASS, "DIFFUSE": DIFFUSE}

# Nodes that a user might expect to convert.
_WITHOUT_COUNTERPART = {
    "ShaderNodeBsdfRefraction": "It refracts without reflecting, which Microbounce does not have: "
    "use a Glass BSDF",
}
NATIVE_TYPES = frozenset(FAMILIES) | frozenset(_WITHOUT_COUNTERPART)


def translated_to_ours(native: State) -> Translation:
    """Return the translation of a native node's state to ours; its target is our kind.

    Raises NotConvertibleError if it has no counterpart.
    """
    if native.idname in _WITHOUT_COUNTERPART:
        raise NotConvertibleError(_WITHOUT_COUNTERPART[native.idname])
    made = FAMILIES[native.idname].forward(native)
    _keep_within_limits(native, made)
    return made


def translated_to_native(kind: str, ours: State, was: State | None) -> Translation:
    """Return the translation of our node's state to a native node; its target is the type.

    `was` is the native state that our node was made from, and gives the type. None takes the
    closest type. Raises NotConvertibleError if that type cannot show it.
    """
    family = NEAREST[kind] if was is None else FAMILIES[was.idname]
    return family.back(_within_limits(kind, ours), was)


def _within_limits(kind: str, ours: State) -> State:
    """Return the state that the shader sees, because scripts can set values beyond the sliders."""
    limits = {p.label: p.legal for p in KINDS[kind].parameters}
    values = {
        name: _cut(value, *limits[name]) if name in limits else value
        for name, value in ours.values.items()
    }
    return replace(ours, values=values)


def _keep_within_limits(native: State, made: Translation) -> None:
    """Cut values to the legal ranges of our parameters, and note it."""
    by_label = {p.label: p for p in KINDS[made.target].parameters}
    hidden = {new for old, new in made.carried.items() if old in native.varying}
    for name, value in made.values.items():
        if name in hidden:
            continue
        parameter = by_label[name]
        try:
            socket_value(parameter, value)
        except ValueError:
            low, high = parameter.legal
            made.values[name] = _cut(value, low, high)
            made.notes.append(f"{name} goes from {low:g} to {high:g} only: it is cut")


def _cut(value: float | list[float], low: float, high: float) -> float | list[float]:
    # In this order NaN becomes `high`.
    if isinstance(value, list):
        return [max(low, min(high, component)) for component in value]
    return max(low, min(high, value))
