# SPDX-License-Identifier: GPL-3.0-or-later
"""What is proposed for surfaces and their shares of a picture: no Blender is needed."""

import itertools

import numpy as np
import pytest

from addon.core.analysis.picture_error import equal_part, picture_error
from addon.core.analysis.prediction import (
    QUALITIES,
    Choice,
    Surface,
    predicted_cost,
    predicted_error,
)
from addon.core.analysis.proposal import (
    Option,
    Shown,
    _upgrades,
    _worth,
    propose,
    time_ratio,
    total_error,
)
from addon.core.analysis.step_errors import STEPS, background
from addon.core.kinds import KINDS

FITTED, WALK = Choice("Fitted", 16), Choice("Walk", 16)


def surface(kind: str, alpha: float, **values: object) -> Surface:
    return Surface(kind, (alpha**0.5, alpha**0.5), **values)


def proposed(one: Surface, now: Choice = FITTED, share: float = 0.5, tolerance: float = 0.01):
    (made,) = propose([Shown(one, now, share)], tolerance)
    return made


def crowd(now: Choice = WALK, **values: object) -> list[Shown]:
    """Surfaces of all kinds and alphas, with shares of 1 to 6 %."""
    surfaces = [surface(k, a, **values) for k in KINDS for a in (0.01, 0.1, 0.3, 0.6, 1.0)]
    return [Shown(one, now, 0.01 + 0.01 * (i % 6)) for i, one in enumerate(surfaces)]


def total_cost(proposals: list) -> float:
    return sum(one.share * one.cost_then for one in proposals)


def test_the_picture_is_within_the_tolerance_where_it_can_be() -> None:
    """And no plain choice that is within it, of one step for all, costs less."""
    for tolerance in (0.3, 0.1, 0.03, 0.01, 0.005):
        made = propose(crowd(), tolerance)
        best = propose(crowd(), 1e-6)
        error, least = total_error(made)[1], total_error(best)[1]
        assert error <= max(tolerance, 1.1 * least)  # what is left out by Max Bounces varies
        for step in STEPS:
            plain = [(one, Choice(step, 16)) for one in crowd()]
            errors = [(one.share, predicted_error(one.surface, choice)) for one, choice in plain]
            if picture_error(errors) <= tolerance:
                costs = [one.share * predicted_cost(one.surface, choice) for one, choice in plain]
                assert total_cost(made) <= sum(costs) * 1.001


def test_it_is_the_cheapest_of_all_choices_but_for_one_change() -> None:
    """Of six surfaces all 729 choices are tried."""
    shown = [one for one in crowd() if one.surface.roughness[0] > 0.5][:6]
    options = [[Choice(step, 16) for step in STEPS] for _ in shown]
    tolerance = 0.02
    made = propose(shown, tolerance)
    least = np.inf
    for choices in itertools.product(*options):
        pairs = list(zip(shown, choices, strict=True))
        error = picture_error([(one.share, predicted_error(one.surface, c)) for one, c in pairs])
        if error <= tolerance:
            cost = sum(one.share * predicted_cost(one.surface, c) for one, c in pairs)
            least = min(least, cost)
    one_change = max(one.share * (p.cost_then) for one, p in zip(shown, made, strict=True))
    assert np.isfinite(least)
    assert total_cost(made) <= least + one_change
    assert total_error(made)[1] <= tolerance


def test_a_tighter_tolerance_never_costs_less() -> None:
    made = [propose(crowd(), tolerance) for tolerance in np.geomspace(0.5, 0.001, 20)]
    costs, errors = [total_cost(one) for one in made], [total_error(one)[1] for one in made]
    assert all(b >= a - 1e-9 for a, b in itertools.pairwise(costs))
    assert all(b <= a + 1e-4 for a, b in itertools.pairwise(errors))  # Max Bounces vary a little
    assert costs[-1] > 1.05 * costs[0]


def test_smooth_metal_needs_no_further_bounces() -> None:
    made = proposed(surface("CONDUCTOR", 0.01), WALK)
    assert made.then.quality == "Single"
    assert made.error_then < 0.01
    assert "further bounces carry" in made.reason


def test_rough_metal_is_fitted_and_says_why() -> None:
    made = proposed(surface("CONDUCTOR", 0.5))
    assert made.then == FITTED
    assert "Single would be" in made.reason
    assert not made.changes


def test_what_is_both_cheapest_and_nearest_says_so() -> None:
    made = proposed(surface("DIFFUSE", 1.0))
    assert made.then == FITTED
    assert made.reason == "alpha 1: no step costs less or is nearer"


def test_nothing_is_paid_for_what_is_not_needed() -> None:
    """Rough glass takes a cheaper step where it fills little of the picture."""
    rough = surface("DIELECTRIC", 1.0)
    large, small = (proposed(rough, WALK, share, 0.02) for share in (1.0, 0.005))
    assert small.cost_then < large.cost_then
    assert small.error_then > large.error_then


def test_exact_is_never_proposed() -> None:
    for kind in KINDS:
        made = proposed(surface(kind, 1.0), Choice("Exact", 16), tolerance=1e-4)
        assert made.then.quality in STEPS


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


def test_fitted_that_takes_walk_is_left_alone() -> None:
    for one in (
        surface("CONDUCTOR", 0.5, models=(1,)),
        surface("DIELECTRIC", 0.5, ior=(3.0, 3.0)),
        surface("DIFFUSE", 0.5, anisotropy=(0.5, 0.5)),
    ):
        assert proposed(one, FITTED).then.quality != "Walk"


def test_what_must_stay_stays_and_uses_up_tolerance() -> None:
    bad = Shown(surface("CONDUCTOR", 1.0), Choice("Single", 16), 0.5, "Quality is linked")
    other = Shown(surface("CONDUCTOR", 0.1), WALK, 0.4)
    alone, beside = propose([other], 0.02)[0], propose([bad, other], 0.02)
    assert not beside[0].changes
    assert beside[0].reason == "Quality is linked: it stays"
    assert alone.then.quality == "Single"
    assert beside[1].then.quality == "Fitted"


def test_proposing_again_changes_nothing() -> None:
    for quality, model, bounces in itertools.product(QUALITIES, (0, 2), (3, 16)):
        shown = crowd(Choice(quality, bounces), models=(model,))
        made = propose(shown, 0.01)
        again = [Shown(s.surface, p.then, s.share) for s, p in zip(shown, made, strict=True)]
        assert not any(one.changes for one in propose(again, 0.01))


def test_every_step_is_predicted() -> None:
    """Also where nothing may change; what is proposed is one of them."""
    rough = surface("CONDUCTOR", 0.75)
    made = proposed(rough, WALK)
    assert [option.choice.quality for option in made.steps] == list(QUALITIES)
    single, fitted = made.steps[:2]
    assert (fitted.choice, fitted.error, fitted.cost) == (
        made.then,
        made.error_then,
        made.cost_then,
    )
    assert single.error > 0.3
    assert single.loss > 0.3 > fitted.loss
    (kept,) = propose([Shown(rough, WALK, 0.5, "It is linked")], 0.01)
    assert kept.steps == made.steps
    assert not kept.changes


def test_options_that_are_not_worth_it_are_left_out() -> None:
    def option(error: float, cost: float) -> Option:
        return Option(FITTED, error, cost, 0.0)

    cheap, near, dear = option(0.1, 1.0), option(0.01, 2.0), option(0.0095, 3.0)
    assert _worth([dear, near, cheap]) == [cheap, near]
    assert _worth([cheap, option(0.05, 1.01)]) == [option(0.05, 1.01)]
    assert _worth([cheap, option(0.2, 2.0)]) == [cheap]
    # A small step on the way to a large one that gains more is passed over.
    assert [to for _, to in _upgrades([cheap, option(0.09, 1.9), near])] == [near]
    gains = [gain for gain, _ in _upgrades([cheap, near, option(0.001, 9.0)])]
    assert gains == sorted(gains, reverse=True)
    assert len(gains) == 2


def test_equal_parts_spend_the_tolerance() -> None:
    shares = (0.5, 0.3, 0.01, 0.005)
    parts = [equal_part(share, 4, 0.01) for share in shares]
    assert picture_error(zip(shares, parts, strict=True)) == pytest.approx(0.01)


def test_time_counts_what_is_around() -> None:
    made = propose([Shown(surface("CONDUCTOR", 0.5), WALK, 0.5)], 0.01)
    (one,) = made
    alone = one.cost_then / one.cost_now
    assert time_ratio(made) == pytest.approx(
        (0.5 * one.cost_then + 0.5) / (0.5 * one.cost_now + 0.5)
    )
    assert alone < time_ratio(made, empty=0.5) < time_ratio(made) < 1.0
    assert 0.0 < background() < 1.0
    assert time_ratio([]) == 1.0
    assert propose([], 0.01) == []
