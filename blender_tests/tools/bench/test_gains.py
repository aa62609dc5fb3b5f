# SPDX-License-Identifier: GPL-3.0-or-later
"""Each change of gains.md is in today's shaders, and the page tells its gain."""

import pytest

from addon.core.kinds import kind_named
from scenes.timing import SampleTimes
from tools.bench import gains
from tools.bench.shaders import replaced_source


@pytest.mark.parametrize("change", gains.CHANGES, ids=lambda one: f"{one.quality}: {one.what}")
def test_each_change_is_in_todays_shader(change):
    kind = gains.kind_of(change.stage)
    source = replaced_source(kind, change.patches)
    assert all(ours not in source for ours, _ in change.patches)
    assert all(name in kind_named(kind).by_identifier for name, _ in change.values)
    assert change.patches or change.values


def test_a_change_that_no_longer_is_there_is_told():
    with pytest.raises(ValueError, match="0 times, not once"):
        replaced_source("CONDUCTOR", (("int no_such_line;", ""),))


def test_the_page_tells_a_gain_and_where_there_is_none():
    first, second, *_ = gains.CHANGES
    seconds = {"with": [1.0, 1.0, 2.0], first.what: [1.25, 1.2, 2.6], second.what: [1.0, 1.01, 2.0]}
    times = SampleTimes(seconds, {})
    text = gains.page({first: times, second: times}, "Some processor")
    assert f"| {first.what} | metal | Fitted | 1.25 (1.20 to 1.30) | 20% |" in text
    assert f"| {second.what} | metal | Fitted | 1.00 (1.00 to 1.01) | no clear gain |" in text
