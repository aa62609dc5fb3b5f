# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that once failed, by name, with what was wrong. Run one with pytest -k "name"."""

from dataclasses import dataclass, replace

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
    "next height, near the top": Value(
        "next_height",
        {
            "alpha": (0.0001, 0.0001, 0.0),
            "log_u": -1.0,
            "number": 0.9999999403953552,
            "o": (1.0, 0.0, 5e-05),
        },
        "was -1.5e-5 for -1.6e-7: log(u) and the rise from there cancel",
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


_PLAIN = Thing(
    kind="CONDUCTOR",
    finish="linked",
    shape="plane",
    inputs={
        "Quality": 2,
        "Model": 0,
        "Distribution": 1,
        "Roughness": 0.01,
        "Anisotropy": 0.0,
        "Rotation": 0.0,
        "Tangent": (0.0, 0.0, 0.0),
        "Normal": (0.999, 0.0, -0.01),
        "BaseColor": (1.0, 1.0, 1.0),
        "EdgeTint": (1.0, 1.0, 1.0),
    },
    flipped=False,
    cosine=0.1,
    scale=(1.0, 1.0, 1.0),
    rotation=(0.0, 0.0, 0.0),
    moving=False,
    nested=False,
)
_GLASS = {
    name: value for name, value in _PLAIN.inputs.items() if name not in ("BaseColor", "EdgeTint")
}
_GLASS |= {"Color": (1.0, 1.0, 1.0), "IOR": 1.0001, "Model": 1, "Normal": (0.0, 0.0, 0.0)}

THINGS = {
    "metal of alpha 1e-4 along the horizon": Picture(
        _PLAIN,
        "showed more than the furnace: Cycles turns the first bounce's normal up to where it loses "
        "nothing to masking (Bump Map Correction), and walks about the other normal came on top",
    ),
    "smooth glass of alpha 0": Picture(
        replace(
            _PLAIN,
            kind="DIELECTRIC",
            inputs=_GLASS | {"Quality": 0, "Distribution": 0, "Roughness": 0.0, "IOR": 2.0},
        ),
        "showed its refraction twice: the ratio of two NDFs of width 0 was 0",
    ),
    "bumped glass that is hardly there": Picture(
        replace(_PLAIN, kind="DIELECTRIC", finish="textured", shape="slant", inputs=_GLASS),
        "showed more than the furnace where bumps turn the normal far from a grazing surface",
    ),
}
