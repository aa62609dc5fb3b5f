# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings: their levels, order and texts."""

import pytest

from addon.core.finding import Finding, by_level, counts, worst


def test_levels_of_findings():
    with pytest.raises(ValueError, match="The level is 'bad': use one of error, warning, note"):
        Finding("bad", "Scene", "It is bad.")
    note, error = Finding("note", "A", "Small."), Finding("error", "B", "Big.", "Mend it.")
    assert (worst([]), worst([note]), worst([note, error])) == ("", "note", "error")
    assert by_level([note, error]) == (error, note)
    assert counts([note, error, note]) == "1 error, 2 notes"
    assert error.as_text() == "Error: B: Big. Mend it."
    assert error.as_dict() == {
        "level": "error",
        "subject": "B",
        "message": "Big.",
        "remedy": "Mend it.",
    }
