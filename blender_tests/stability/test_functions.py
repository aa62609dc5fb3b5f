# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader's functions where they are hardest: at the horizon and the normal, for the smallest
alpha, at the ends of the random numbers, for media that hardly differ, total and no reflection.

Every value is finite and in its range, and within 1e-3 of the oracle's: relative, or where a number
is so small that its error no longer shows in a picture (each function's `floor`) relative to that.
The oracle gets the arguments that the shader gets. Where one rounding of an argument changes the
value by more, near the critical angle say, the oracle's values for both roundings count as right.

Hypothesis draws the cases of a function; they are rendered as one picture. If some fail, it draws
them again, finds the smallest case that fails and prints it: it can be pasted into regressions.py.
"""

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from .functions import FUNCTIONS, Function
from .regressions import VALUES
from .verdicts import Case, columns_of, compared, faults

CASES = 800
SMALLEST_TOTAL = 10_000
# Without a database and a random seed every run has the same cases.
PROFILE = settings(
    max_examples=CASES,
    database=None,
    derandomize=True,
    deadline=None,
    phases=(Phase.generate, Phase.shrink),
    suppress_health_check=list(HealthCheck),
)


def _key(case: Case) -> str:
    return repr(sorted(case.items()))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_values(name: str, report) -> None:
    function = FUNCTIONS[name]
    drawn, known = [], {}

    def judge(case: Case) -> None:
        if not known:
            drawn.append(case)  # judged below, all at once
            return
        if _key(case) not in known:  # on the way to a smaller case
            known[_key(case)] = faults(function, [case])[0]
        assert not known[_key(case)], f"{name}: {known[_key(case)]}"

    @PROFILE
    @given(case=st.fixed_dictionaries(function.arguments))
    def run(case: Case) -> None:
        judge(case)

    run()
    assert len(drawn) == CASES
    said = faults(function, drawn)
    asked = int(compared(function, columns_of(drawn)).sum())
    found = f"{sum(map(bool, said))} of {len(drawn)} cases fail, {asked} have an oracle"
    report(f"stability, {name}", found, "0")
    assert asked >= CASES // 4 or name == "missing_energy_bound"  # a bound has no right value
    if any(said):
        known.update(zip(map(_key, drawn), said, strict=True))
        run()


def test_cases_are_many() -> None:
    assert CASES * len(FUNCTIONS) >= SMALLEST_TOTAL


def test_what_is_not_finite_is_noticed() -> None:
    grows = Function(
        "frame.h", "result = exp(x);", {}, lambda x: np.exp(x), floor=1.0, low=0.0, high=np.inf
    )
    assert faults(grows, [{"x": 1.0}, {"x": 1e4}]) == ["", "not finite"]


@pytest.mark.parametrize("name", VALUES)
def test_regressions(name: str) -> None:
    kept = VALUES[name]
    assert faults(FUNCTIONS[kept.function], [kept.case]) == [""], kept.was
