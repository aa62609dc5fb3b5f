# SPDX-License-Identifier: GPL-3.0-or-later
"""What the analysis predicts, against the oracle, and what it proposes: no Blender is needed."""

import itertools

import numpy as np
import pytest

from addon.core import analysis, picture_error, step_errors
from addon.core.analysis import Choice, Surface, missing_after, predicted_error, propose
from addon.core.kinds import KINDS
from addon.core.reflectance import mean_of_index, mean_of_tint
from blender_tests.oracle import Conductor, Diffuse, IndexOfRefraction, sphere
from blender_tests.oracle import Surface as OracleSurface
from blender_tests.oracle.balanced import BalancedDielectric
from blender_tests.oracle.fresnel import F82Tint
from blender_tests.oracle.reference_cases import CLAY, COPPER, GOLD
from tools import measure_steps
from tools.steps import bounces

FITTED, WALK = Choice("Fitted", 16), Choice("Walk", 16)
ROUGHNESSES = np.linspace(0.0, 1.0, 21)
NAMES = ("GGX", "BECKMANN")


def surface(kind: str, alpha: float, **values: object) -> Surface:
    return Surface(kind, (alpha**0.5, alpha**0.5), **values)


def proposed(one: Surface, now: Choice = FITTED, share: float = 0.1, tolerance: float = 0.01):
    return propose(one, now, share, 5, tolerance)


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
    """Entries computed anew, by another seed, are those of the file within their noise."""
    stored = step_errors.left_out(kind, distribution, 0, (alpha, alpha), (ior, ior))
    made = OracleSurface(alpha, alpha, NAMES[distribution], material)
    found = bounces.left_out(made, walks=400, seed=7)
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
    missing = bounces.left_out(made, walks=400)[0]
    roughness, anisotropy = (alphas[0] * alphas[1]) ** 0.25, (1.0 - alphas[1] / alphas[0]) / 0.9
    predicted = missing_after(
        Surface(
            "CONDUCTOR",
            (roughness, roughness),
            (anisotropy, anisotropy),
            distributions=(distribution,),
        )
    )[0]
    assert missing <= predicted <= 2.0 * missing


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


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("roughness", [0.1, 0.4, 0.7, 1.0])
def test_a_tighter_tolerance_never_costs_less(kind: str, roughness: float) -> None:
    tolerances = np.geomspace(0.3, 0.001, 15)
    made = [propose(Surface(kind, (roughness, roughness)), FITTED, 0.1, 5, t) for t in tolerances]
    held = [one for one in made if one.error_then <= one.limit]
    assert all(b.cost_then >= 0.98 * a.cost_then for a, b in itertools.pairwise(held))
    assert len(held) >= 3


@pytest.mark.parametrize("kind", KINDS)
def test_proposals_keep_their_limit_where_any_step_does(kind: str) -> None:
    for roughness in ROUGHNESSES:
        one = Surface(kind, (roughness, roughness))
        made = proposed(one)
        errors = [predicted_error(one, Choice(step, 16)) for step in step_errors.STEPS]
        assert made.then.quality in step_errors.STEPS
        nearest = min(errors) + 0.1 * made.limit  # which Max Bounces may take of a broken limit
        assert made.error_then <= max(made.limit, 1.1 * nearest)
        assert made.reason.startswith("alpha")


def test_shares_spend_the_tolerance() -> None:
    """Surfaces that are all at their limits are off by the tolerance together, whatever shares."""
    shares = (0.5, 0.3, 0.01, 0.005)
    limits = [picture_error.limit_of(share, 4, 0.01) for share in shares]
    assert picture_error.picture_error(list(zip(shares, limits, strict=True))) == pytest.approx(
        0.01
    )
    assert limits == sorted(limits)


def test_smooth_metal_needs_no_further_bounces() -> None:
    made = proposed(surface("CONDUCTOR", 0.01), WALK)
    assert made.then.quality == "Single"
    assert made.error_then < made.limit
    assert "further bounces carry" in made.reason


def test_rough_metal_is_fitted_and_says_why() -> None:
    made = proposed(surface("CONDUCTOR", 0.5))
    assert made.then == FITTED
    assert "Single would be" in made.reason
    assert made.cost_then < made.cost_now * 1.001


def test_exact_is_never_proposed() -> None:
    for kind in KINDS:
        made = proposed(surface(kind, 1.0), Choice("Exact", 16), tolerance=1e-4)
        assert made.then.quality in step_errors.STEPS
        assert "no step is within" in made.reason


def test_walk_takes_as_few_bounces_as_will_do() -> None:
    """Another model has no table."""
    few = [
        proposed(surface("CONDUCTOR", 1.0, models=(2,)), WALK, tolerance=t).then
        for t in (0.2, 0.05)
    ]
    assert [choice.quality for choice in few] == ["Walk", "Walk"]
    assert 2 <= few[0].max_bounces <= few[1].max_bounces < 16


def test_too_few_bounces_are_raised() -> None:
    made = proposed(surface("CONDUCTOR", 0.75), Choice("Fitted", 2))
    assert made.then.quality == "Fitted"
    assert made.then.max_bounces > 2
    assert made.error_then < 0.5 * made.error_now


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
    """And is then left alone, since it is the same."""
    for one in (
        surface("CONDUCTOR", 0.5, models=(1,)),
        surface("DIELECTRIC", 0.5, ior=(3.0, 3.0)),
        surface("DIFFUSE", 0.5, anisotropy=(0.5, 0.5)),
    ):
        assert not one.fitted
        assert predicted_error(one, FITTED) == predicted_error(one, WALK)
        assert proposed(one, FITTED).then.quality != "Walk"
    partly = surface("DIELECTRIC", 0.5, ior=(1.0, 1.5))
    assert partly.fitted
    assert partly.walked
    assert surface("DIELECTRIC", 0.5, ior=(1 / 1.5, 1 / 1.5)).fitted


def test_more_walks_cost_more() -> None:
    four, eight = (surface("CONDUCTOR", 0.5, walks=w) for w in (4, 8))
    assert analysis.predicted_cost(eight, WALK) > analysis.predicted_cost(four, WALK)


def test_proposing_again_changes_nothing() -> None:
    for kind, roughness, quality in itertools.product(KINDS, (0.1, 0.5, 0.8, 1.0), range(4)):
        for model in (0, 2):
            one = Surface(kind, (roughness, roughness), models=(model,))
            first = proposed(one, Choice(analysis.QUALITIES[quality], 3))
            assert not proposed(one, first.then).changes


def test_bad_intervals_and_names() -> None:
    with pytest.raises(ValueError, match="VELVET"):
        step_errors.left_out("VELVET", 0, 0, (0.5, 0.5))
    assert step_errors.most((0.0, 1.0), (2.0, 4.0), (-1.0, 5.0)) == 4.0


def test_the_file_says_how_it_was_made() -> None:
    text = step_errors.FILE.read_text(encoding="utf-8")
    assert text.startswith(measure_steps.ABOUT)
    assert f"seed = {bounces.SEED}" in text
    assert f"walks = {bounces.WALKS}" in text
