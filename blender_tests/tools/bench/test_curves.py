# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors, times and their comparison, on known curves."""

import math

import numpy as np
import pytest

from blender_tests.tools.bench.synthetic import curve, scene_of, timed
from tools.bench import curves, errors
from tools.bench.measure import split_times
from tools.bench.plan import BALLS, PLANS, levels
from tools.bench.verdict import losses, moment, wins


def test_error_at_a_time_lies_between_the_levels():
    one = curve("Walk", 0.01)  # squared error 1 / samples
    assert one.squared_at(0.04) == pytest.approx(1 / 4)
    assert one.squared_at(0.03) == pytest.approx(1 / 3)
    assert one.error_at(0.16) == pytest.approx(1 / 4)
    assert one.squared_at(0.009) is None
    assert one.squared_at(10.25) is None


def test_time_to_an_error():
    one = curve("Walk", 0.01)
    assert one.seconds_to(0.1) == pytest.approx(1.0)
    assert one.seconds_to(2.0) == pytest.approx(0.01)  # a sample is enough
    assert one.seconds_to(0.01) is None
    assert curve("Single", 0.01, bias=0.2).seconds_to(0.1) is None


def test_gain_at_equal_time_is_the_ratio_of_squares():
    ours, theirs = curve("Walk", 0.02, noise=0.1), curve("One walk", 0.01)
    assert curves.advantage(ours, theirs, 0.64) == pytest.approx(50.0)
    every = curves.advantages(ours, theirs)
    assert [seconds for seconds, _ in every][:: len(every) - 1] == pytest.approx([0.02, 10.24])
    assert all(value == pytest.approx(50.0) for _, value in every)
    assert curves.advantage(ours, theirs, 0.015) is None


def test_without_shared_time_or_reference_there_is_no_gain():
    fast, slow = curve("Single", 0.001, levels=3), curve("Walk", 1.0, levels=3)
    assert curves.shared_times(fast, slow) is None
    assert curves.advantages(fast, slow) == []
    unknown = timed(BALLS[0], {"Walk": 0.01}).curves["Walk"]
    assert not unknown.known
    assert unknown.seconds_to(0.1) is None
    assert curves.advantages(unknown, slow) == []


def test_ratios_of_times_go_round_by_round():
    load = np.array([1.0, 3.0, 1.0, 1.0, 2.0, 1.0, 1.0])
    ours, theirs = curve("Walk", 0.03, load=load), curve("Single", 0.02, load=load)
    assert curves.time_ratios(ours, theirs) == pytest.approx([1.5] * 7)
    assert curves.time_ratio(ours, theirs) == pytest.approx(1.5)
    assert ours.spread == pytest.approx((0.03, 0.09))


def test_a_sample_is_told_from_the_start_of_a_render():
    assert split_times([(0.5, 1), (0.7, 1), (0.8, 2), (1.2, 4)]) == pytest.approx((0.2, 0.4))
    assert split_times([(0.5, 1)]) == (0.5, 0.0)
    assert split_times([(0.5, 1), (0.5, 1), (0.4, 2)])[0] > 0.0


def test_noise_of_the_reference_cancels():
    random = np.random.default_rng(1)
    truth = np.ones((64, 64, 3))
    pair = truth + random.normal(0.0, 0.5, (2, *truth.shape))
    reference = {"first": pair[0], "second": pair[1], "mask": np.ones((64, 64), bool)}
    picture = truth + random.normal(0.0, 0.1, truth.shape)
    assert errors.squared_error(picture, reference) == pytest.approx(0.01, abs=0.01)
    assert 1e-4 < errors.resolution(reference) < 1e-2


def test_what_it_converges_to_is_told_without_noise():
    random = np.random.default_rng(2)
    truth = np.ones((64, 64, 3))
    mask = np.zeros((64, 64), bool)
    mask[16:48] = True
    reference = {"first": truth, "second": truth, "mask": mask}
    pictures = list(1.2 * truth + random.normal(0.0, 0.5, (2, *truth.shape)))
    found = errors.converged(pictures, reference)
    assert found.bias == pytest.approx(0.2, abs=5 * found.bias_se)
    assert found.bias_se < 0.02
    assert found.resolved
    assert errors.converged(pictures[:1], reference) is None
    assert errors.converged(pictures, {"mask": mask}) is None


def test_a_variant_may_have_a_reference_of_its_own():
    truth = np.ones((4, 4, 3))
    reference = {"first": truth, "second": truth, "mask": np.ones((4, 4), bool), "Own": 2.0 * truth}
    assert errors.squared_error(2.0 * truth, reference) == pytest.approx(1.0)
    assert errors.squared_error(2.0 * truth, reference, "Own") == 0.0
    assert math.isnan(errors.squared_error(truth, {"mask": reference["mask"]}))


def test_losses_and_wins_are_told_where_they_are():
    cycles = curve("Cycles, OSL on", 0.01, noise=0.3, bias=0.05)
    fitted, walk = curve("Fitted", 0.011, 0.1, 0.01), curve("Walk", 0.02, 2.0, 0.01)
    one = scene_of(BALLS[0], {c.variant: c for c in (fitted, walk, cycles)})
    (lost,), won = losses([one]), wins([one])
    assert lost.startswith(f"{BALLS[0].title}: Walk has the larger error")
    assert [line.partition(": ")[2].partition(" ")[0] for line in won] == ["Fitted"]
    assert "at all times" in won[0]
    assert moment(one) == ("Cycles, OSL on", pytest.approx(0.16))
    worse = scene_of(BALLS[0], {"Fitted": curve("Fitted", 0.02, 0.3, 0.1), cycles.variant: cycles})
    text = "\n".join(losses([worse]))
    assert "at all times" in text
    assert "Fitted is 10.00 % off and Cycles 5.00 %. A sample takes 2.00 times" in text
    assert wins([worse]) == []


def test_levels_double_up_to_the_top():
    assert levels(8) == [1, 2, 4, 8]
    for top in (0, 3, -4):
        with pytest.raises(ValueError, match=f"top is {top}"):
            levels(top)


def test_the_plans_name_each_scene_once_and_take_enough_rounds():
    for plan in PLANS.values():
        names = [scene.name for scene in plan]
        assert len(set(names)) == len(names)
    for scene in (*PLANS["full"], *PLANS["quick"]):
        assert len(scene.tops) >= curves.FEWEST_ROUNDS
        assert scene.whole_work > 0
    scene = PLANS["quick"][0]
    assert scene.repeated(3).tops[: len(scene.tops)] == scene.tops
    assert scene.repeated(3).whole_work == 3 * scene.whole_work
