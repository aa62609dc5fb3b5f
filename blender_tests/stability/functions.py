# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader's functions under test, each with what it is asked for and the oracle's answer.

An oracle takes the arguments as the shader gets them, float32 numbers, in float64 arrays (n,) or
(n, 3) by name, and returns (n,) or (n, channels).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hypothesis.strategies import SearchStrategy
from scipy.special import erf, exprel

from blender_tests.osl.samples import SURFACE
from osl.oracle import masking, visible
from osl.oracle.error_function import deficit
from osl.oracle.fresnel import F82Tint, IndexOfRefraction, dielectric_reflectance
from osl.oracle.materials import Diffuse
from osl.oracle.surface import BECKMANN, CORRELATED, GGX, UNCORRELATED
from osl.oracle.vectors import dot

from . import answers
from . import arguments as a

_METAL = "Conductor metal; metal.physical = {}; metal.first = color(f0); metal.second = color(f1);"
_GLASS = (
    "Material material; material.kind = DIELECTRIC; material.ior = eta; int crossed;"
    "float cosine = clamp(dot(view, m), 0, 1);"
)
# The logarithm that the shader takes of 0 (smith.h).
_LOG_ZERO = np.log(1e-37)
# Heights u are known to one step of float32 below 1: 1e-3 of this.
_HEIGHT = 1e-4
# Below this log(u) lies nothing: u is 1e-43.
_DEEPEST = -100.0


@dataclass(frozen=True)
class Function:
    """`statements` with functions of `header` assign `result`, of which `oracle` knows the first
    channels. Errors are relative, and absolute below `floor`. Arguments in `rounded` are known to
    one part in 2^24 of 1 alone. All channels lie in `low` to `high`. `defined` tells which cases
    the oracle is asked for."""

    header: str
    statements: str
    arguments: dict[str, SearchStrategy]
    oracle: Callable[..., np.ndarray]
    floor: float
    low: float = 0.0
    high: float = np.inf
    rounded: tuple[str, ...] = ()
    defined: Callable[..., np.ndarray] | None = None


_VIEW = "Incidence arrival = incidence(surface, view);"
_FACETS = {"view": a.DIRECTION, "m": a.DIRECTION, "eta": a.INDEX}

FUNCTIONS = {
    "projected areas": Function(
        "smith.h",
        f"{SURFACE} {_VIEW} result = vector(arrival.area, arrival.excess, 0);",
        {"alpha": a.surfaces(), "view": a.DIRECTION},
        answers.areas,
        floor=1e-30,
    ),
    "exit_probability": Function(
        "smith.h",
        f"{SURFACE} {_VIEW} result = exit_probability(surface, arrival, o);",
        {
            "alpha": a.surfaces(models=(CORRELATED, UNCORRELATED)),
            "view": a.DIRECTION,
            "o": a.DIRECTION,
        },
        answers.leaving,
        floor=1e-6,
        high=1.0,
        defined=lambda alpha, view, o: answers.seen(alpha, view),
    ),
    "escape_chance": Function(
        "smith.h",
        f"{SURFACE} result = escape_chance(surface, o, log_u);",
        {"alpha": a.surfaces(), "o": a.DIRECTION, "log_u": a.LOG_U},
        answers.escaping,
        floor=1e-6,
        high=1.0,
    ),
    "height_met": Function(
        "smith.h",
        f"{SURFACE} {_VIEW} float height = height_met(arrival, number);"
        f"result = isfinite(height) ? max(height, {_DEEPEST}) : height;",
        {"alpha": a.surfaces(), "view": a.DIRECTION, "number": a.UNIFORM},
        lambda alpha, view, number: np.maximum(answers.met(alpha, view, number), _DEEPEST),
        floor=_HEIGHT,
        low=-np.inf,
        high=0.0,
        rounded=("number",),
        defined=lambda alpha, view, number: (
            (number >= answers.SMALLEST) & answers.seen(alpha, view)
        ),
    ),
    "next_height": Function(
        "smith.h",
        f"{SURFACE} result = next_height(surface, o, log_u, number);",
        {"alpha": a.surfaces(), "o": a.DIRECTION, "log_u": a.LOG_U, "number": a.UNIFORM},
        answers.next_heights,
        floor=_HEIGHT,
        low=-np.inf,
        high=0.0,
        rounded=("number",),
        defined=lambda alpha, o, log_u, number: (
            (number >= answers.SMALLEST) & answers.stays(alpha, o, log_u)
        ),
    ),
    "height_from_below": Function(
        "smith.h",
        "result = height_from_below(log_u);",
        {"log_u": a.LOG_U},
        lambda log_u: np.maximum(masking.height_from_below(log_u), _LOG_ZERO),
        floor=_HEIGHT,
        low=-np.inf,
        high=0.0,
    ),
    "crossing_probability": Function(
        "smith.h",
        f"{SURFACE} {_VIEW} result = crossing_probability(surface, arrival, o);",
        {"alpha": a.surfaces(), "view": a.DIRECTION, "o": a.DIRECTION},
        answers.crossing,
        floor=1e-6,
        high=1.0,
        # Exactly along the horizon a path meets the very top, and never crosses; there the oracle
        # itself stands on its cap of 1e15 for what is infinite.
        defined=lambda alpha, view, o: answers.seen(alpha, view) & (view[:, 2] != 0.0),
    ),
    "log1p_over": Function(
        "smith.h",
        "result = log1p_over(number);",
        {"number": a.NUMBER},
        lambda number: np.where(number > 0.0, np.log1p(number) / np.maximum(number, 1e-300), 1.0),
        floor=1e-30,
        high=1.0,
    ),
    "stirling_remainder": Function(
        "smith.h",
        "result = stirling_remainder(part);",
        {"part": a.UNIFORM},
        answers.stirling,
        floor=1e-30,
    ),
    "one_minus_exp": Function(
        "smith.h",
        "result = one_minus_exp(log_u) / -log_u;",
        {"log_u": a.LOG_U},
        lambda log_u: exprel(log_u),
        floor=1e-30,
        high=1.0,
    ),
    "missing_energy_bound": Function(
        "smith.h",
        f"{SURFACE} result = missing_energy_bound(surface, view);",
        {"alpha": a.surfaces(), "view": a.DIRECTION},
        lambda alpha, view: np.empty((len(view), 0)),  # a bound has no right value
        floor=1.0,
        high=1.0,
    ),
    "dielectric_fresnel": Function(
        "fresnel.h",
        "result = dielectric_fresnel(eta, cosine);",
        {"eta": a.INDEX, "cosine": a.COSINE},
        lambda eta, cosine: dielectric_reflectance(cosine, eta),
        floor=1e-6,
        high=1.0,
        rounded=("cosine",),
    ),
    "F82 tint": Function(
        "fresnel.h",
        f"{_METAL.format(0)} result = vector(conductor_fresnel(metal, cosine));",
        {"f0": a.COLOUR, "f1": a.COLOUR, "cosine": a.COSINE},
        lambda f0, f1, cosine: answers.metals(F82Tint, f0, f1, cosine),
        floor=1e-3,
        high=1.0,
    ),
    "n and k": Function(
        "fresnel.h",
        f"{_METAL.format(1)} result = vector(conductor_fresnel(metal, cosine));",
        {"f0": a.COMPLEX, "f1": a.COMPLEX, "cosine": a.COSINE},
        # Where there is no medium at all the oracle has no answer.
        lambda f0, f1, cosine: answers.metals(
            IndexOfRefraction, np.where((f0 == 0.0) & (f1 == 0.0), 1e-9, f0), f1, cosine
        ),
        floor=1e-3,
        high=1.0,
        rounded=("cosine", "f0"),
    ),
    "refracted": Function(
        "material.h",
        f"{_GLASS} result = refracted(view, m, cosine, eta);",
        _FACETS,
        answers.through,
        floor=1.0,
        low=-1.0 - 1e-6,
        high=1.0 + 1e-6,
        rounded=("view",),
        defined=lambda view, m, eta: dot(view, m) >= 0.0,
    ),
    "scattered by glass": Function(
        "material.h",
        f"{_GLASS} result = scattered(material, view, m, 0, cosine, xi[0], xi[1], crossed);",
        {**_FACETS, "xi": a.THREE_UNIFORMS},
        answers.scattered,
        floor=1.0,
        low=-1.0 - 1e-6,
        high=1.0 + 1e-6,
        rounded=("view",),
        defined=answers.clearly_chosen,
    ),
    "scattered by matte facets": Function(
        "material.h",
        "result = cosine_direction(m, xi[0], xi[1]);",
        {"m": a.DIRECTION, "xi": a.THREE_UNIFORMS},
        lambda m, xi: (
            Diffuse.scatter(Diffuse(), m, m, None, answers.Given(1.0 - xi[:, 0], xi[:, 1])).o
        ),
        floor=1.0,
        low=-1.0 - 1e-6,
        high=1.0 + 1e-6,
        rounded=("m", "xi"),
        # a chance of 2e-7
        defined=lambda m, xi: np.linalg.norm(answers.around(m, xi), axis=-1) > 1e-3,
    ),
    "sample_visible_normal, GGX": Function(
        "visible.h",
        f"{SURFACE} {_VIEW} result = sample_visible_normal(surface, arrival, xi);",
        {"alpha": a.surfaces((GGX,)), "view": a.DIRECTION, "xi": a.THREE_UNIFORMS},
        answers.normals,
        floor=1.0,
        low=-1.0 - 1e-6,
        high=1.0 + 1e-6,
        rounded=("xi",),
        # The rim of the cap, where the height of the facet is lost.
        defined=lambda alpha, view, xi: xi[:, 0] <= 1.0 - 1e-6,
    ),
    "sample_visible_normal, Beckmann": Function(
        "visible.h",
        f"{SURFACE} {_VIEW} vector m = sample_visible_normal(surface, arrival, xi);"
        "result = vector(length(m), max(-dot(m, view), 0), m[2]);",
        {"alpha": a.surfaces((BECKMANN,)), "view": a.DIRECTION, "xi": a.THREE_UNIFORMS},
        lambda alpha, view, xi: np.tile([1.0, 0.0], (len(view), 1)),  # of length 1, and visible
        floor=1e-3,
        high=1.0 + 1e-6,
        defined=lambda alpha, view, xi: answers.seen(alpha, view),
    ),
    "beckmann_tail_slope": Function(
        "visible.h",
        # Over the most frequent slope, 1 / (a + sqrt(a^2 + 2)).
        "result = beckmann_tail_slope(cotangent, number)"
        "* (cotangent + sqrt(cotangent * cotangent + 2));",
        {"cotangent": a.NUMBER, "number": a.UNIFORM},
        lambda cotangent, number: (
            (-visible.slope_along(-cotangent, number) - cotangent)
            * (cotangent + np.sqrt(cotangent**2 + 2.0))
        ),
        floor=1.0,
        rounded=("number",),
        defined=lambda cotangent, number: (
            (number >= answers.SMALLEST) & (number < 1.0) & (cotangent < 1e3)
        ),
    ),
    "ierfcx": Function(
        "../tables/special.h",
        "result = ierfcx(x);",
        {"x": a.NUMBER},
        deficit,
        floor=1e-30,
        high=0.5642,
    ),
    "fraction_on_side": Function(
        "exits.h",
        "result = fraction_on_side(z, spread);",
        {"z": a.NUMBER, "spread": a.NUMBER},
        lambda z, spread: 0.5 * (1.0 + erf(z / np.maximum(spread, 1e-300))),
        floor=1e-6,
        low=0.5,
        high=1.0,
        # A lobe without width at the horizon is on either side.
        defined=lambda z, spread: spread > 0.0,
    ),
}
