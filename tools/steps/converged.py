# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the errors of each step's converged pictures against the oracle's references."""

from collections import defaultdict
from collections.abc import Callable

from addon.core.analysis.step_errors import STEPS
from scenes import pictures
from scenes.pictures import WHITE, Widths
from scenes.references import CASES, Case

ISOTROPIC, ANISOTROPIC = "isotropic", "anisotropic"
METALS = [
    *(
        Case("sun", "CONDUCTOR", Widths(alpha, alpha), distribution)
        for distribution in ("GGX", "Beckmann")
        for alpha in (0.1, 0.25, 0.5, 0.75, 1.0)
    ),
    *(Case("sun", "CONDUCTOR", Widths(1.0, 0.1), d) for d in ("GGX", "Beckmann")),
]
FEWEST_SAMPLES, MOST_SAMPLES = 64, 1024
LARGEST_SPREAD = 0.003


def rows(tell: Callable[[str], None]) -> list[dict]:
    """Return a row of errors by the larger alpha for each kind, sort, distribution and step.

    The sort is "isotropic", "anisotropic", or a model that is not height-correlated. Single is
    compared with the oracle's first bounce, the other steps with all bounces. Each error includes
    its standard error, and is the largest of all lights. `tell` prints the progress.
    """
    found: dict[tuple[str, str, str, str], dict[float, float]] = defaultdict(dict)
    for case in (*METALS, *CASES):
        for step in STEPS:
            # References of this model have no first bounce.
            if step == "Single" and case.model == "height-tracked":
                continue
            error = measured(case, step)
            tell(f"{case.reference}, {step}: {error:.2%}")
            row = found[case.kind, _sort(case), case.distribution, step]
            alpha = case.widths.alpha_x  # the larger one
            row[alpha] = max(row.get(alpha, 0.0), error)
    return [
        {
            "kind": kind,
            "sort": sort,
            "distribution": distribution.upper(),
            "step": step,
            "alphas": sorted(row),
            "errors": [row[alpha] for alpha in sorted(row)],
        }
        for (kind, sort, distribution, step), row in found.items()
    ]


def measured(case: Case, step: str) -> float:
    """Return the error of the converged picture plus its standard error.

    If the standard error is large, the pictures get more samples, up to MOST_SAMPLES.
    """
    wanted = pictures.reference(case.reference)
    material = pictures.open_lit(case.light, case.kind)
    colours = WHITE if case.kind == "CONDUCTOR" else {}
    pictures.set_values(material, {**colours, **case.values, "Quality": step})
    layer = wanted["single" if step == "Single" else "mean"]
    samples = min(case.samples, FEWEST_SAMPLES)
    while True:
        a, b = pictures.independent_pictures(samples, 2)
        error, spread = pictures.unbiased_l2_error(a, b, layer, wanted["mask"])
        if spread <= LARGEST_SPREAD or samples >= MOST_SAMPLES:
            return error + spread
        samples *= 4


def _sort(case: Case) -> str:
    if case.model != "height-correlated":
        return case.model
    return ISOTROPIC if case.widths.alpha_x == case.widths.alpha_y else ANISOTROPIC
