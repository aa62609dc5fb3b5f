# SPDX-License-Identifier: GPL-3.0-or-later
"""What the analysis predicts of surfaces, against the oracle: no Blender is needed."""

import itertools

import numpy as np
import pytest

from addon.core.analysis import prediction as analysis
from addon.core.analysis import step_errors
from addon.core.analysis.prediction import (
    Choice,
    Surface,
    missing_after,
    predicted_error,
)
from addon.core.analysis.reflectance import mean_of_index, mean_of_tint
from addon.core.kinds import KINDS
from osl.oracle import Conductor, Diffuse, IndexOfRefraction, sphere
from osl.oracle import Surface as OracleSurface
from osl.oracle.balanced import BalancedDielectric
from osl.oracle.fresnel import F82Tint
from osl.oracle.reference_cases import CLAY, COPPER, GOLD
from tools.steps import __main__ as measure_steps
from tools.steps import bounces

FITTED, WALK = Choice("Fitted", 16), Choice("Walk", 16)
ROUGHNESSES = np.linspace(0.0, 1.0, 21)
NAMES = ("GGX", "BECKMANN")


def surface(kind: str, alpha: float, **values: object) -> Surface:
    return Surface(kind, (alpha**0.5, alpha**0.5), **values)


@pytest.mark.parametrize(
    ("kind", "material", "alpha", "ior"),
    [
        ("CONDUCTOR", Conductor(), 0.1, 1.5),
        ("CONDUCTOR", Conductor(), 1.0, 1.5),
        ("DIFFUSE", Diffuse(), 0.5, 1.5),
        ("DIELECTRIC", BalancedDielectric(1.5), 0.25, 1.5),
        ("DIELECTRIC", BalancedDielectric(2.5), 1.0, 2.5),
    ],
)
@pytest.mark.parametrize("distribution", [0, 1])
def test_the_data_are_the_oracles(
    kind: str, material: object, alpha: float, ior: float, distribution: int
) -> None:
    """Entries computed again, by another seed, are those of the file within their noise."""
    made = OracleSurface(alpha, alpha, NAMES[distribution], material)
    for of, measure in (("left_out", bounces.left_out), ("lost", bounces.energy_lost)):
        stored = step_errors.left_out(kind, distribution, 0, (alpha, alpha), (ior, ior), of)
        found = measure(made, walks=400, seed=7)
        for bounce in range(2):
            a, b = (row[bounce] if bounce < len(row) else 0.0 for row in (stored, found))
            assert a == pytest.approx(b, rel=0.1, abs=0.002)


@pytest.mark.parametrize(
    ("kind", "alpha", "material", "colour", "distribution"),
    [
        ("CONDUCTOR", 0.5, Conductor(GOLD), mean_of_tint(GOLD.base_color, GOLD.edge_tint), 0),
        ("CONDUCTOR", 1.0, Conductor(GOLD), mean_of_tint(GOLD.base_color, GOLD.edge_tint), 0),
        ("CONDUCTOR", 0.5, Conductor(COPPER), mean_of_index(COPPER.n, COPPER.k), 1),
        ("DIFFUSE", 1.0, CLAY, (0.8, 0.5, 0.2), 0),
    ],
    ids=["gold", "rough gold", "copper", "clay"],
)
def test_colours_bound_what_the_oracle_misses(
    kind: str, alpha: float, material: object, colour: tuple, distribution: int
) -> None:
    """After one to three bounces it is 0.8 to 1.6 times the oracle's: one Fresnel factor stands for
    all facets, and the norms of the bounces are added."""
    made = OracleSurface(alpha, alpha, NAMES[distribution], material)
    light = bounces.light(made, sphere.FRONT_SUN, False, walks=1000, seed=3)
    missing = bounces.missing(light)
    predicted = missing_after(surface(kind, alpha, colour=colour, distributions=(distribution,)))
    for found, wanted in zip(predicted[:3], missing[:3], strict=True):
        assert 0.8 * wanted - 0.001 <= found <= 1.6 * wanted + 0.002


@pytest.mark.parametrize("distribution", [0, 1])
@pytest.mark.parametrize("alphas", [(1.0, 0.1), (0.5, 0.2)])
def test_anisotropy_is_bounded_by_the_larger_alpha(
    alphas: tuple[float, float], distribution: int
) -> None:
    made = OracleSurface(*alphas, NAMES[distribution])
    roughness, anisotropy = (alphas[0] * alphas[1]) ** 0.25, (1.0 - alphas[1] / alphas[0]) / 0.9
    one = Surface(
        "CONDUCTOR",
        (roughness, roughness),
        (anisotropy, anisotropy),
        distributions=(distribution,),
    )
    for of, measure in (("left_out", bounces.left_out), ("lost", bounces.energy_lost)):
        missing = measure(made, walks=400)[0]
        assert missing <= missing_after(one, of)[0] <= 2.0 * missing


def test_reflectances_are_the_oracles() -> None:
    """Means over the hemisphere, by the oracle's factors on a fine grid."""
    cosines = np.sqrt((np.arange(2000) + 0.5) / 2000)
    for base, edge in (((0.95, 0.75, 0.35), (0.98, 0.95, 0.75)), ((0.1, 0.5, 1.0), (0.2, 1, 0.5))):
        wanted = F82Tint(base, edge)(cosines).mean(axis=0)
        assert mean_of_tint(base, edge) == pytest.approx(wanted, abs=0.005)
    n, k = (0.2, 0.92, 2.7), (3.91, 2.45, 3.8)
    wanted = IndexOfRefraction(n, k)(cosines).mean(axis=0)
    assert mean_of_index(n, k) == pytest.approx(wanted, abs=0.005)
    assert mean_of_index((0.0,) * 3, (0.0,) * 3) == (1.0, 1.0, 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_missing_rises_with_alpha_and_falls_with_bounces(kind: str) -> None:
    rows = [missing_after(Surface(kind, (r, r))) for r in ROUGHNESSES]
    first = [row[0] for row in rows]
    assert all(a <= b + 0.003 for a, b in itertools.pairwise(first))
    assert first[0] == 0.0
    assert first[-1] > 0.15
    for row in rows:
        assert list(row) == sorted(row, reverse=True)


def test_an_interval_takes_its_worst_alpha() -> None:
    wide = Surface("CONDUCTOR", (0.1, 1.0))
    for quality in ("Single", "Fitted", "Walk"):
        parts = [Surface("CONDUCTOR", (r, r)) for r in np.linspace(0.1, 1.0, 30)]
        worst = max(predicted_error(part, Choice(quality, 16)) for part in parts)
        assert predicted_error(wide, Choice(quality, 16)) >= worst - 1e-9


def test_dark_facets_lose_less() -> None:
    white, grey, black = (
        missing_after(surface("DIFFUSE", 1.0, colour=(c,) * 3))[0] for c in (1.0, 0.5, 0.0)
    )
    assert white > 1.5 * grey > 0.0
    assert black == 0.0


def test_fitted_takes_walk_without_a_table() -> None:
    for one in (
        surface("CONDUCTOR", 0.5, models=(1,)),
        surface("DIELECTRIC", 0.5, ior=(3.0, 3.0)),
        surface("DIFFUSE", 0.5, anisotropy=(0.5, 0.5)),
    ):
        assert not one.fitted
        assert predicted_error(one, FITTED) == predicted_error(one, WALK)
    partly = surface("DIELECTRIC", 0.5, ior=(1.0, 1.5))
    assert partly.fitted
    assert partly.walked
    assert surface("DIELECTRIC", 0.5, ior=(1 / 1.5, 1 / 1.5)).fitted


def test_more_walks_cost_more() -> None:
    four, eight = (surface("CONDUCTOR", 0.5, walks=w) for w in (4, 8))
    assert analysis.predicted_cost(eight, WALK) > analysis.predicted_cost(four, WALK)


def test_bad_intervals_and_names() -> None:
    with pytest.raises(ValueError, match="VELVET"):
        step_errors.left_out("VELVET", 0, 0, (0.5, 0.5))
    assert step_errors.most((0.0, 1.0), (2.0, 4.0), (-1.0, 5.0)) == 4.0


def test_the_file_says_how_it_was_made() -> None:
    text = step_errors.FILE.read_text(encoding="utf-8")
    assert text.startswith(measure_steps.ABOUT)
    assert f"seed = {bounces.SEED}" in text
    assert f"walks = {bounces.WALKS}" in text
