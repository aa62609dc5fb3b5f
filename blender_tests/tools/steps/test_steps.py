# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored errors and costs of the analysis agree with new measurements."""

import pytest

from addon.core.analysis import step_errors
from scenes.pictures import Widths
from scenes.references import Case
from tools.steps import converged, costs

REMEDY = "run `python -m tools.steps`"


@pytest.mark.parametrize(
    ("kind", "distribution", "alpha", "step"),
    [
        ("CONDUCTOR", "GGX", 0.5, "Fitted"),
        ("CONDUCTOR", "GGX", 0.25, "Walk"),
        ("DIFFUSE", "GGX", 1.0, "Fitted"),
    ],
)
def test_errors_are_todays(kind: str, distribution: str, alpha: float, step: str) -> None:
    case = Case("sun", kind, Widths(alpha, alpha), distribution)
    number = step_errors.NAMES.index(distribution.upper())
    stored = step_errors.off(kind, number, step_errors.ISOTROPIC, step, (alpha, alpha))
    assert stored == pytest.approx(converged.measured(case, step), rel=0.15, abs=0.001), REMEDY


@pytest.mark.nightly
@pytest.mark.timing
def test_costs_are_todays() -> None:
    """One short round agrees within a third."""
    rows, background = costs.measure(("CONDUCTOR",), (0.25,), samples=32, rounds=1)
    assert [row["step"] for row in rows] == list(step_errors.STEPS)
    for row in rows:
        stored = step_errors.cost("CONDUCTOR", row["step"], (0.25, 0.25))
        assert row["costs"] == pytest.approx([stored], rel=0.33), REMEDY
    assert background == pytest.approx(step_errors.background(), abs=0.05), REMEDY
