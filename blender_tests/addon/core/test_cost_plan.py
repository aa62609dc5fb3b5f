# SPDX-License-Identifier: GPL-3.0-or-later
"""What is rendered follows from the options, and options that make no sense say why."""

import json

import pytest

from addon.core.cost.options import listed, parse_numbers, parse_region, parse_steps
from addon.core.cost.plan import STEPS, Options, PlanError, planned_variants


def test_what_is_rendered_unless_asked_otherwise():
    variants = planned_variants(Options())
    assert [v.title for v in variants if v.family == "step"] == list(STEPS)
    assert [v.settings["MaxBounces"] for v in variants if v.family == "bounces"] == [1, 2, 4, 8, 16]
    assert [(v.native, v.osl) for v in variants if v.family == "cycles"] == [
        (True, True),
        (True, False),
    ]
    assert len({v.key for v in variants}) == len(variants) == 11


def test_walks_and_kernels_as_asked():
    variants = planned_variants(
        Options(steps=(), bounces=(1, 1), walks=(2,), kernels=(0.2, 0.4), baselines=False)
    )
    assert [v.title for v in variants] == [
        "Walk, 1 bounce",
        "Walk, 2 walks",
        "Walk, kernel 0.2",
        "Walk, kernel 0.4",
    ]


def test_options_survive_json():
    options = Options(kernels=(0.2,), region=(0.1, 0.2, 0.8, 1.0))
    assert Options.from_dict(json.loads(json.dumps(options.as_dict()))) == options


def test_texts_are_read():
    assert parse_numbers(" 1, 2 4,") == (1, 2, 4)
    assert parse_numbers("None") == parse_numbers("") == ()
    assert parse_numbers("0.5", float) == (0.5,)
    assert parse_steps("walk,FITTED") == ("Fitted", "Walk")
    assert parse_region("0,0,0.5,1") == (0.0, 0.0, 0.5, 1.0)
    assert parse_numbers(listed((1, 2))) == (1, 2)
    assert parse_steps(listed(STEPS)) == STEPS


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"samples": 1}, "Samples cannot be 1: give 2 or more"),
        ({"samples": -4}, "Samples cannot be -4"),
        ({"percentage": 101}, "1 to 100"),
        ({"rounds": 1}, "one picture shows no noise"),
        ({"reference_samples": 3}, "4 or more"),
        ({"error": 0.0}, "above 0"),
        ({"error": float("nan")}, "above 0"),
        ({"reference": "FITTED"}, "WALK or EXACT"),
        ({"steps": ("Best",)}, "Single, Fitted, Walk, Exact"),
        ({"bounces": (0,)}, "Bounces"),
        ({"walks": (0,)}, "Walks"),
        ({"kernels": (-1.0,)}, "Kernel"),
        ({"region": (0.5, 0.0, 0.5, 1.0)}, "x0 < x1"),
        ({"region": (0.0, 0.0, 1.0, float("nan"))}, "y0 < y1"),
        ({"steps": (), "bounces": (), "baselines": False}, "Nothing is to be rendered"),
    ],
)
def test_options_that_make_no_sense(changes, message):
    with pytest.raises(PlanError, match=message):
        Options(**changes)


@pytest.mark.parametrize(
    ("parse", "text", "message"),
    [
        (parse_numbers, "1, two", "'two' is no number: give whole numbers"),
        (parse_numbers, "1.5", "'1.5' is no number"),
        (parse_steps, "fitted, best", "Step cannot be Best: give Single, Fitted, Walk, Exact"),
        (parse_region, "0,0,1", "four numbers"),
        (parse_region, "a,b,c,d", "'a' is no number: give numbers"),
    ],
)
def test_texts_that_cannot_be_read(parse, text, message):
    with pytest.raises(PlanError, match=message):
        parse(text)
