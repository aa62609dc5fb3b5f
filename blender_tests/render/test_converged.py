# SPDX-License-Identifier: GPL-3.0-or-later
"""Walk with its default kernel and walks against the oracle: every material, light and model.

The error is that of the converged picture, without the noise of its few samples
(`pictures.unbiased_l2_error`); the references' own noise, at most 0.5 %, is part of it. Limits are
the product's promises: matte surfaces 3 %, metal and glass 5 %, and 10 % where an anisotropic
surface refracts. Reflection is measured where the sun shines on the side that is seen, transmission
under a sun from behind and through a slab.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from . import pictures
from .pictures import Widths

# Samples of each of a case's two renders. Reflections of glass of alpha 1 are the dim part of its
# light, and its transmission has narrow lobes: they have more noise.
SAMPLES = {"sun": 64, "back": 192, "inside": 128, "slab": 64}
SAMPLES_OF_DIM_REFLECTIONS = 256
SAMPLES_OF_WIDE_REFRACTIONS = 768
SAMPLES_OF_FIRST_BOUNCES = 48
# From so many on one Blender version is enough.
LONG = 256
LIMITS = {"CONDUCTOR": 0.05, "DIELECTRIC": 0.05, "DIFFUSE": 0.03}
# Of refraction by a surface whose narrower alpha is below 0.3: Cycles' refraction is isotropic, so
# that its lobes are as wide one way as the other.
LIMIT_OF_NARROW_REFRACTION = 0.1
# How the references' names call them. A white metal and glass of IOR 1.5 lose nothing.
NAMES = {"CONDUCTOR": "white", "DIELECTRIC": "glass", "DIFFUSE": "diffuse"}
OTHER_MODELS = ("height-uncorrelated", "height-tracked")
CLAY = {"Color": (0.8, 0.5, 0.2)}


@dataclass(frozen=True)
class Case:
    """A reference picture, and what gives it in Blender."""

    light: str
    kind: str
    widths: Widths
    distribution: str = "GGX"
    model: str = "height-correlated"

    @property
    def reference(self) -> str:
        """The name of its file."""
        model = self.model.removeprefix("height-")
        parts = [self.light, NAMES[self.kind], self.distribution.lower(), self.widths.name]
        return "_".join(parts if model == "correlated" else [*parts, model])

    @property
    def samples(self) -> int:
        """Of a render of all bounces."""
        if self.kind == "DIELECTRIC" and self.widths.alpha_x == 1.0:
            if self.light == "sun":
                return SAMPLES_OF_DIM_REFLECTIONS
            if self.light == "back":
                return SAMPLES_OF_WIDE_REFRACTIONS
        return SAMPLES[self.light]

    @property
    def limit(self) -> float:
        """Of the error."""
        if self.light == "back" and self.widths.alpha_y < 0.3:
            return LIMIT_OF_NARROW_REFRACTION
        return LIMITS[self.kind]

    @property
    def values(self) -> dict[str, object]:
        """The inputs of the material."""
        return {"Distribution": self.distribution, "Model": self.model, **self.widths.inputs}


def _isotropic(light: str, kind: str, *alphas: float, distribution: str = "GGX") -> list[Case]:
    return [Case(light, kind, Widths(a, a), distribution) for a in alphas]


def _sphere(light: str, kind: str) -> list[Case]:
    rough = Widths(1.0, 1.0)
    return [
        *_isotropic(light, kind, 0.3, 1.0),
        *_isotropic(light, kind, 0.3, 1.0, distribution="Beckmann"),
        Case(light, kind, Widths(1.0, 0.1)),
        *(Case(light, kind, rough, model=model) for model in OTHER_MODELS),
    ]


CASES = [
    *(Case("sun", "CONDUCTOR", Widths(1.0, 1.0), model=model) for model in OTHER_MODELS),
    *_sphere("sun", "DIFFUSE"),
    *_sphere("sun", "DIELECTRIC"),
    *_sphere("back", "DIELECTRIC"),
    *_isotropic("inside", "DIELECTRIC", 0.5),
    *_isotropic("slab", "DIELECTRIC", 0.1, 0.3, 0.6, 1.0),
]
# The first bounce of the height-tracked model is the height-correlated one.
# Refracted by a surface of alpha 1 it has too much noise to say more than all bounces do.
FIRST_BOUNCES = [
    case
    for case in CASES
    if case.model != "height-tracked" and case.samples != SAMPLES_OF_WIDE_REFRACTIONS
]


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case,
            id=case.reference,
            marks=[pytest.mark.once] if case.samples >= LONG else [],
        )
        for case in CASES
    ],
)
def test_walk(case: Case, report) -> None:
    """All bounces."""
    _hold("Walk", case, "mean", case.samples, case.limit, report)


@pytest.mark.once
@pytest.mark.parametrize("case", FIRST_BOUNCES, ids=lambda case: case.reference)
def test_first_bounce(case: Case, report) -> None:
    """Bounce 1 alone against the oracle's own, which is no promise: 5 % for all materials."""
    _hold("bounce 1", case, "single", SAMPLES_OF_FIRST_BOUNCES, 0.05, report, BounceOnly=1)


def test_walk_of_coloured_diffuse(report) -> None:
    """Each bounce takes its own albedo: hue and saturation are the oracle's."""
    wanted = pictures.reference("sun_clay_ggx_1")
    mask, mean = wanted["mask"], wanted["mean"]
    a, b = _pair("sun", "DIFFUSE", SAMPLES["sun"], {**CLAY, **Widths(1.0, 1.0).inputs})
    error, spread = pictures.unbiased_l2_error(a, b, mean, mask)
    limit = LIMITS["DIFFUSE"]
    ratios = (a + b)[mask].mean(axis=0) / (2.0 * mean[mask].mean(axis=0))
    report("Walk, sun_clay_ggx_1", f"{error:.2%} +- {spread:.2%}", f"{limit:.0%}")
    report("Walk, sun_clay_ggx_1: R, G, B", ", ".join(f"{r:.4f}" for r in ratios), "1 +- 0.02")
    assert error < limit
    assert abs(ratios - 1.0).max() < 0.02


def _hold(
    what: str,
    case: Case,
    layer: str,
    samples: int,
    limit: float,
    report,
    **values: object,
) -> None:
    wanted = pictures.reference(case.reference)
    mask, mean = wanted["mask"], wanted[layer]
    a, b = _pair(case.light, case.kind, samples, {**case.values, **values})
    error, spread = pictures.unbiased_l2_error(a, b, mean, mask)
    noisy = pictures.l2_error(a, mean, mask)
    energy = pictures.energy_ratio(0.5 * (a + b), mean, mask)
    report(
        f"{what}, {case.reference}",
        f"{error:.2%} +- {spread:.2%} (with noise {noisy:.1%}), energy {energy:.4f}",
        f"{limit:.0%}",
    )
    assert error < limit


def _pair(
    light: str, kind: str, samples: int, values: dict[str, object]
) -> tuple[np.ndarray, np.ndarray]:
    """Two independent pictures in Walk."""
    pictures.set_values(pictures.open_lit(light, kind), {"Quality": "Walk", **values})
    a, b = pictures.independent_pictures(samples, 2)
    return a, b
