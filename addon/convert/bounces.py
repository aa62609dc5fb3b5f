# SPDX-License-Identifier: GPL-3.0-or-later
"""Microfacet distributions and the light of further bounces, on native nodes and on ours."""

from ..core.parameters import SHARED
from .state import State
from .translation import NotConvertibleError, Translation, need_fixed

_SINGLE = SHARED["Quality"].checked("Single")
_FITTED = SHARED["Quality"].checked("Fitted")
_GGX = SHARED["Distribution"].checked("GGX")
_BECKMANN = SHARED["Distribution"].checked("Beckmann")

# Above these, the mean colour of Multiscatter GGX differs from ours by 2 % or more.
_VISIBLE_GLASS, _VISIBLE_METAL = 0.35, 0.7

_NAMES = {"GGX": _GGX, "MULTI_GGX": _GGX, "BECKMANN": _BECKMANN}


def distribution_to_ours(native: State, made: Translation) -> None:
    """Set Distribution and Quality from the node's `distribution`.

    Raises NotConvertibleError for a distribution that is none of ours.
    """
    name = native.settings["distribution"]
    if name not in _NAMES:
        raise NotConvertibleError(
            f"Its distribution is {name.replace('_', '-').title()}, which Microbounce does not "
            "have: choose GGX, Multiscatter GGX or Beckmann"
        )
    made.values["Distribution"] = _NAMES[name]
    made.values["Quality"] = _FITTED
    if name == "MULTI_GGX":
        _note_scaled(made)
    else:
        made.notes.append(
            f"Cycles' {name if name == 'GGX' else name.title()} leaves further bounces out: it "
            "becomes brighter where rough. Quality 0 (Single) leaves them out too"
        )


def _note_scaled(made: Translation) -> None:
    """Note where Multiscatter GGX, which scales the light of one bounce, differs visibly.

    A linked or animated input counts with the value that it hides.
    """
    if made.target == "DIELECTRIC":
        if made.values["Roughness"] > _VISIBLE_GLASS:
            made.notes.append(
                "Cycles' rough glass is some per cent too bright where lights are sampled: it "
                "becomes darker"
            )
    elif made.values["Anisotropy"] > 0.0:
        made.notes.append("Anisotropic Multiscatter GGX loses light: it becomes brighter")
    elif made.values["Roughness"] > _VISIBLE_METAL:
        made.notes.append("Very rough metal becomes some per cent brighter")


def distribution_to_native(ours: State, made: Translation) -> None:
    """Set the node's `distribution` from Distribution and Quality.

    Raises NotConvertibleError if Distribution is linked or animated.
    """
    need_fixed(ours, "Distribution", "the native node's distribution takes no link")
    single = ours.is_fixed("Quality", _SINGLE)
    if ours.values["Distribution"] == _BECKMANN:
        made.settings["distribution"] = "BECKMANN"
        if not single:
            made.notes.append("Cycles has no further bounces for Beckmann: it becomes darker")
    elif single:
        made.settings["distribution"] = "GGX"
    else:
        made.settings["distribution"] = "MULTI_GGX"
        if not ours.is_fixed("Quality", _FITTED):
            made.notes.append("Multiscatter GGX stands for the further bounces")
    note_model(ours, made)


def note_model(ours: State, made: Translation) -> None:
    """Note the values that native nodes cannot show."""
    for name in ("Model", "Bounce Only"):
        if not ours.is_fixed(name, 0):
            made.notes.append(f"{name} has no counterpart: kept for the way back")


def note_isotropic(ours: State, made: Translation, native: str) -> None:
    """Note an anisotropy that the node `native` cannot show."""
    if not ours.is_fixed("Anisotropy", 0.0):
        made.notes.append(f"{native} has no anisotropy: kept for the way back")
