# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's table of parameters against the one specification of them."""

from pathlib import Path

import pytest

from addon.core.parameters import CONDUCTOR

README = Path(__file__).resolve().parents[2] / "README.md"
ROWS = {
    cells[0]: cells[1:]
    for line in README.read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and len(cells := [cell.strip() for cell in line.split("|")[1:-1]]) == 4
}
SURFACES_OWN = ("NORMAL", "TANGENT")


@pytest.mark.parametrize("parameter", CONDUCTOR, ids=lambda parameter: parameter.identifier)
def test_parameter_is_described_as_it_is(parameter) -> None:
    if parameter.kind in SURFACES_OWN:
        assert "Normal, Tangent" in ROWS
        return
    default, span, text = ROWS[parameter.label]
    values = parameter.default if parameter.is_vector else (parameter.default,)
    assert default == ", ".join(f"{value:g}" for value in values)
    assert span == f"{parameter.legal[0]:g} to {parameter.legal[1]:g}"
    for number, choice in enumerate(parameter.choices):
        if parameter.identifier != "Model":  # its table row tells which are still to come
            assert f"{number} {choice}" in text
