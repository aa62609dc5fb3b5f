# SPDX-License-Identifier: GPL-3.0-or-later
"""The sentence, the tables and the page say what was measured, and hold all that they need."""

import csv
import io
import json
import math
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest

from addon.core.cost.advice import bias_text, duration, recommendation
from addon.core.cost.page import MOST_BYTES, to_html
from addon.core.cost.plot import COLORS, Dot, Label, Line, draw_plot, svg
from addon.core.cost.results import TOO_SHORT
from addon.core.cost.tables import to_csv, to_json, to_text
from blender_tests.addon.cost.cost_support import measured, noisy_pictures, report

SINGLE = measured("single", seconds=1.0, bias=0.2, noise=0.05)
FITTED = measured("fitted", seconds=2.0, bias=0.005, noise=0.1)
WALK = measured("walk", seconds=4.0, bias=0.0, noise=0.2)
CYCLES = measured("cycles_osl", bias=0.12, noise=0.1, family="cycles", memory=None)
ALL = (SINGLE, WALK, FITTED, CYCLES)


class _Page(HTMLParser):
    """Notes the tags that are open, and the addresses of all that a browser would load."""

    EMPTY = ("meta", "img")

    def __init__(self):
        super().__init__()
        self.open, self.wrong, self.addresses, self.rows = [], [], [], 0

    def handle_starttag(self, tag, attrs):
        self.addresses += [value for name, value in attrs if name in ("src", "href", "srcset")]
        self.rows += tag == "tr"
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            self.wrong.append(tag)


def test_times_and_errors_follow_from_the_split():
    assert FITTED.seconds == pytest.approx(2.0)
    assert FITTED.seconds_to(0.02) == pytest.approx(2.0 * 0.1**2 / (0.02**2 - 0.005**2))
    assert FITTED.error_at(FITTED.seconds_to(0.02)) == pytest.approx(0.02)
    assert SINGLE.seconds_to(0.02) == math.inf
    assert [v.key for v in report(*ALL).ranked()] == ["fitted", "walk", "cycles_osl", "single"]


def test_the_sentence_names_the_soonest_and_compares():
    sentence = recommendation(ALL, 0.02)
    times = WALK.seconds_to(0.02) / FITTED.seconds_to(0.02)
    assert sentence == (
        f"Fitted is within 2 % soonest here, after {duration(FITTED.seconds_to(0.02))}; "
        f"{times:.1f} times faster than Walk; never within it: Single ({'bias 20 % ± 0.0025 %'})."
    )


def test_the_sentence_where_none_comes_near():
    assert recommendation([SINGLE, CYCLES], 0.02) == (
        "No step comes within 2 % here; nearest is Single, bias 20 % ± 0.0025 %."
    )
    assert "nearest is Cycles_Osl" in recommendation([CYCLES], 0.02), "no step was measured"


def test_no_times_are_told_that_are_none():
    quick = measured("walk", seconds=16 * TOO_SHORT, bias=0.001)
    assert recommendation([FITTED, quick], 0.02).startswith(
        "The renders are too short to be timed: give more samples or a larger size. Nearest is Walk"
    )
    mixed = report(quick, FITTED)
    assert [variant.key for variant in mixed.ranked()] == ["fitted", "walk"], "no time, no rank"
    assert mixed.equal_time == pytest.approx(FITTED.seconds)
    row = next(line for line in to_text(mixed).splitlines() if line.startswith("Walk"))
    assert row.split("  ")[0] == "Walk"
    assert row.count("too short") == 4, "to the target, error, time, processor"
    times = [label.text for label in draw_plot(mixed) if isinstance(label, Label)]
    assert "Walk" not in times
    assert times == [label.text for label in draw_plot(report(FITTED)) if isinstance(label, Label)]
    alone = report(quick)
    assert alone.as_dict()["equal_time"] is None
    assert "Error at equal time" in to_text(alone)
    for made in (mixed, alone):
        assert "e-0" not in to_text(made)
        page = to_html(made, noisy_pictures(made.variants))
        assert "too short" in page
        read = json.loads(to_json(made))["variants"][-1]
        assert not read["timed"]
        assert read["seconds"] is read["seconds_to_error"] is read["error_at_equal_time"] is None
        assert next(csv.DictReader(io.StringIO(to_csv(made))))["timed"] in ("True", "False")


def test_the_sentence_tells_what_the_noise_hides():
    hidden = measured("exact", bias=0.0, noise=3.0, se=0.01)
    sentence = recommendation([FITTED, hidden], 0.02)
    assert sentence.startswith("Fitted is within 2 % soonest here")
    assert sentence.endswith(" The noise leaves open Exact: give more samples or more rounds.")
    assert recommendation([SINGLE, hidden], 0.02).startswith(
        "As far as the noise shows, Exact is within 2 % soonest"
    )
    assert bias_text(hidden) == "below 17 %"


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.012, "0.012 s"), (12.3, "12 s"), (119.0, "119 s"), (210.0, "3.5 min"), (7560.0, "2.1 h")],
)
def test_durations_read_well(seconds, text):
    assert duration(seconds) == text


def test_json_holds_everything():
    read = json.loads(to_json(report(*ALL)))
    assert read["sentence"] == "A sentence."
    assert read["setting"]["file"] == "a<b.blend"
    assert read["equal_time"] == pytest.approx(FITTED.seconds)
    rows = {row["key"]: row for row in read["variants"]}
    assert rows["single"]["seconds_to_error"] is None
    assert rows["cycles_osl"]["memory_mb"] is None
    assert rows["fitted"]["flip"] is None, "a key that scripts may read"
    assert rows["fitted"]["bias"] == pytest.approx(0.005)
    assert rows["walk"]["error_at_equal_time"] == pytest.approx(0.2 * math.sqrt(2.0))


def test_csv_has_a_line_for_each_variant():
    rows = list(csv.DictReader(io.StringIO(to_csv(report(*ALL)))))
    assert [row["key"] for row in rows] == ["fitted", "walk", "cycles_osl", "single"]
    assert rows[3]["seconds_to_error"] == rows[3]["flip"] == ""
    assert float(rows[0]["noise"]) == pytest.approx(0.1)
    assert len(rows[0]["seconds_per_sample"].split()) == 3


def test_text_lines_up():
    lines = to_text(report(*ALL)).splitlines()
    assert len({len(line) for line in lines[:5]}) == 1
    assert lines[0].split()[:4] == ["Variant", "Time", "to", "2"]
    assert "not measured" in lines[3]
    assert lines[-2:] == ["A sentence.", "A note."]


def test_the_page_holds_everything_itself():
    page = to_html(report(*ALL), noisy_pictures(ALL))
    parsed = _Page()
    parsed.feed(page)
    assert (parsed.open, parsed.wrong) == ([], [])
    assert len(parsed.addresses) == 1 + 2 * len(ALL)
    assert all(address.startswith("data:image/png;base64,") for address in parsed.addresses)
    assert not re.search(r"https?:(?!//www.w3.org/2000/svg)|@import|url\(", page)
    assert parsed.rows == 1 + len(ALL)
    assert "a&lt;b.blend" in page
    assert "A &amp; B" in page
    assert "a<b" not in page


def test_a_page_of_many_large_pictures_stays_small():
    many = tuple(measured(f"walk{i}", bias=0.01 * i) for i in range(8))
    page = to_html(report(*many), noisy_pictures(many, 700))
    assert len(page.encode()) <= MOST_BYTES
    assert page.count("data:image/png") == 17


def test_the_plot_stays_within_its_frame_and_tells_variants_apart():
    variants = tuple(measured(f"walk{i}", seconds=10.0**i, bias=0.1**i) for i in range(len(COLORS)))
    steps = draw_plot(report(*variants))
    dots = [step for step in steps if isinstance(step, Dot)]
    assert {dot.color for dot in dots} == set(COLORS)
    for step in steps:
        points = step.points if isinstance(step, Line) else ((step.x, step.y),)
        assert all(0.0 <= x <= 860.0 and 0.0 <= y <= 460.0 for x, y in points)
    assert {v.title for v in variants} <= {s.text for s in steps if isinstance(s, Label)}
    drawing = svg(steps)
    assert drawing.count("<circle") == len(dots)
    assert ElementTree.fromstring(drawing).tag == "{http://www.w3.org/2000/svg}svg"


def test_a_plot_of_one_variant_without_noise():
    steps = draw_plot(report(measured("walk", bias=0.0, noise=1e-9)))
    assert all(np.isfinite(step.points).all() for step in steps if isinstance(step, Line))
