# SPDX-License-Identifier: GPL-3.0-or-later
"""Walk with its default kernel and walks against the oracle: every material, light and model.

The error is that of the converged picture, without the noise of its few samples
(`pictures.unbiased_l2_error`); the references' own noise, at most 0.5 %, is part of it. Limits are
the product's promises: matte surfaces 3 %, metal and glass 5 %, and 10 % where an anisotropic
surface refracts. Reflection is measured where the sun shines on the side that is seen, transmission
under a sun from behind and through a slab.
"""

import numpy as np
import pytest

from scenes import pictures
from scenes.pictures import Widths
from scenes.references import CASES, SAMPLES, SAMPLES_OF_WIDE_REFRACTIONS, Case

pytestmark = pytest.mark.nightly

SAMPLES_OF_FIRST_BOUNCES = 48
LIMITS = {"CONDUCTOR": 0.05, "DIELECTRIC": 0.05, "DIFFUSE": 0.03}
# Of refraction by a surface whose narrower alpha is below 0.3: Cycles' refraction is isotropic, so
# that its lobes are as wide one way as the other.
LIMIT_OF_NARROW_REFRACTION = 0.1
CLAY = {"Color": (0.8, 0.5, 0.2)}


def limit_of(case: Case) -> float:
    """Of the error."""
    if case.light == "back" and case.widths.alpha_y < 0.3:
        return LIMIT_OF_NARROW_REFRACTION
    return LIMITS[case.kind]


# The first bounce of the height-tracked model is the height-correlated one.
# Refracted by a surface of alpha 1 it has too much noise to say more than all bounces do.
FIRST_BOUNCES = [
    case
    for case in CASES
    if case.model != "height-tracked" and case.samples != SAMPLES_OF_WIDE_REFRACTIONS
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.reference)
def test_walk(case: Case, report) -> None:
    """All bounces."""
    _hold("Walk", case, "mean", case.samples, limit_of(case), report)


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
