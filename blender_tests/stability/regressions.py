# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that once failed, by name, with what was wrong. Run one with pytest -k "name"."""

from dataclasses import dataclass

from .crowd import Thing
from .verdicts import Case


@dataclass(frozen=True)
class Value:
    """Arguments of a function of functions.py, and what it returned."""

    function: str
    case: Case
    was: str


VALUES = {
    "height from below, near the top": Value(
        "height_from_below",
        {"log_u": -1.0000000116860974e-07},
        "log(1 - u) was -15.94 for -16.12: OSL's expm1 has steps of 6e-8 about 0",
    ),
    "next height, hardly ever met": Value(
        "next_height",
        {
            "alpha": (0.00010415981523692608, 0.00010415981523692608, 3.0),
            "log_u": -80.0,
            "number": 0.5,
            "o": (0.7071067690849304, 0.7071067690849304, 0.0003419677377678454),
        },
        "was -40.12 for -40.00: 1 - number stays keeps few digits of a small chance to stay",
    ),
    "glass of a very low index, straight on": Value(
        "dielectric_fresnel",
        {"cosine": 1.0, "eta": 0.010016879066824913},
        "was 0.9619 for 0.9607: (eta^2 + 1) c^2 - 1 cancels",
    ),
    "Beckmann's normals from below, last random number": Value(
        "sample_visible_normal, Beckmann",
        {
            "alpha": (0.0001, 0.0001, 1.0),
            "view": (1.0, 0.0, -0.0001),
            "xi": (1.0, 0.0, 1.0),
        },
        "the facet faced away: a random number of 1 was not below the chance of 1",
    ),
}


@dataclass(frozen=True)
class Picture:
    """A thing of crowd.py, and what was seen."""

    thing: Thing
    was: str


THINGS: dict[str, Picture] = {}
