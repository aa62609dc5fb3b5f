# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of mutants fits the code: each text to be replaced is there once."""

from pathlib import Path

import pytest

from blender_tests.mutants.catalogue import MUTANTS

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize("mutant", MUTANTS, ids=[mutant.name for mutant in MUTANTS])
def test_a_mutant_changes_its_file(mutant) -> None:
    text = (ROOT / mutant.path).read_text("utf-8")
    assert mutant.apply(text) != text


def test_mutants_are_told_by_their_names() -> None:
    assert len({mutant.name for mutant in MUTANTS}) == len(MUTANTS) >= 20
