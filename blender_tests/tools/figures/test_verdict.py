# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's sentences follow the data."""

import numpy as np
import pytest

from osl.oracle.surface import BECKMANN, GGX
from tools.figures.cases import ALPHAS, COLUMNS, LOBE_FIGURES, MATERIALS, MODELS, THETAS
from tools.figures.findings import Comparison, Findings
from tools.figures.lobes import BOUNCES, LOBES, Estimate, Lobes
from tools.figures.markdown import in_words, thousandths
from tools.figures.verdict import OURS, agreement, claim, largest


def compared(models, apart, distribution=BECKMANN):
    """Comparisons of all cases, ``apart`` a function of model and theta."""
    noise = np.full(LOBES + 1, 0.001)
    energies = np.zeros((LOBES, 2))
    return [
        Comparison(
            distribution, material, alpha, theta, model,
            np.full(LOBES + 1, np.hypot(apart(model, theta), 0.001)), noise, energies, energies,
        )
        for material in MATERIALS
        for alpha in ALPHAS
        for theta in THETAS
        for model in models
    ]  # fmt: skip


def test_agreement_counts_the_cases():
    text = agreement(compared(MODELS, lambda model, theta: 0.01 if model == "correlated" else 0.05))
    text = " ".join(text.split())
    assert "uncorrelated model in 0, the correlated model in 48" in text
    assert "All three agree: none." in text
    assert "None agrees: none." in text
    text = agreement(compared(MODELS, lambda model, theta: 0.03 if theta == 1.5 else 0.01))
    text = " ".join(text.split())
    assert "uncorrelated model in 36, the correlated model in 36" in text
    assert "None agrees: diffuse, α = 0.25 (θ = 1.5); diffuse, α = 0.5 (θ = 1.5);" in text
    assert "| θ = 1.5 | 3.0 (3.0) | 3.0 (3.0) | 3.0 (3.0) |" in text


@pytest.mark.parametrize(
    ("apart", "first", "second"),
    [
        (lambda model, theta: 0.01 if model == OURS[0] else 0.02, "confirmed", "confirmed"),
        (lambda model, theta: 0.03 if theta == 0.0 else 0.01, "in most cases", "contradicted"),
        (lambda model, theta: 0.05 if model == OURS[0] else 0.02, "contradicted", "contradicted"),
    ],
)
def test_the_claim_is_judged_by_the_data(apart, first, second):
    text = claim(compared(OURS, apart) + compared(OURS, apart, GGX))
    sentences = text.split("- The ")
    assert first in sentences[1]
    assert second in sentences[2]


def test_a_difference_within_the_noise_is_none():
    text = claim(
        compared(OURS, lambda model, theta: 0.0100 if model == "correlated" else 0.0105)
        + compared(OURS, lambda model, theta: 0.01, GGX)
    )
    assert "in 0 of 48, and nearer in 0: none." in " ".join(text.split())


def shown(share):
    """Panels of all figures whose light all goes through, ``share`` of it at the first bounce."""
    energies = np.zeros((BOUNCES, 2))
    energies[:2, 1] = share, 1.0 - share
    one = Lobes(*[Estimate(energies, energies)] * 3, energies, 0.0, 0.0)
    panels = {(column, theta): one for column in COLUMNS for theta in THETAS}
    return Findings({}, dict.fromkeys(LOBE_FIGURES, panels), {}, {}, {}, {}, {}, {}, {})


def test_the_largest_differences_have_their_numbers():
    def apart(model, theta):
        return 0.3 if theta == 1.5 and model == "uncorrelated" else 0.01

    every = compared(MODELS, apart)
    glass = [one for one in every if one.material == "dielectric"]
    text = largest(shown(0.25), glass)
    words = " ".join(text.split())
    assert "The largest distance is 30.0 % of the light, uncorrelated, dielectric" in words
    assert "on the simulated surface 75 % of what goes through" in words
    assert "so what is left is for want of the height" in words
    assert text.count("| dielectric, ") == len(ALPHAS) * len(COLUMNS)
    assert "| simulated | 0.000 | 1.000 | 0.250 | 0.750 | 0.000 | 0.000 | 0.000 |  |" in text
    opaque = [one for one in every if one.material == "diffuse"]
    assert "all cases in which no light goes through" in largest(shown(0.25), opaque)
    text = largest(shown(0.25), compared(MODELS, lambda model, theta: 0.02))
    assert text.endswith("elsewhere in: none.")


def test_words_for_cases_and_numbers():
    found = [("diffuse", (1.0, 1.0), 0.0), ("diffuse", (1.0, 1.0), 1.5), ("x", (1.0, 0.1), 0.5)]
    assert in_words(found) == "diffuse, α = 1 (θ = 0, 1.5); x, α = (1, 0.1) (θ = 0.5)"
    assert [thousandths(x, True) for x in (0.0012, -0.0012, -1e-6)] == ["+1.2", "−1.2", "0.0"]
