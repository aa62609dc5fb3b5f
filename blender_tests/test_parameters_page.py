# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables in docs/parameters.md agree with the specification of the parameters."""

from pathlib import Path

import pytest

from addon.core.kinds import KINDS

PAGE = Path(__file__).resolve().parents[1] / "docs" / "parameters.md"
ALL = "all three"
SURFACES_OWN = ("NORMAL", "TANGENT")


def tables() -> dict[str, dict[str, list[str]]]:
    """Each table by the first cell of its head, as rows by their first cell."""
    found: dict[str, dict[str, list[str]]] = {}
    rows: dict[str, list[str]] = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if not line.startswith("|"):
            rows = {}
            continue
        first, *cells = (cell.strip() for cell in line.split("|")[1:-1])
        if not rows:
            found[first] = rows
        rows[first] = cells
    return found


TABLES = tables()


@pytest.mark.parametrize(
    ("kind", "parameter"),
    [
        pytest.param(kind, parameter, id=f"{kind.label} {parameter.identifier}")
        for kind in KINDS.values()
        for parameter in kind.parameters
    ],
)
def test_parameter_is_described_as_it_is(kind, parameter) -> None:
    if parameter.type in SURFACES_OWN:
        assert "Normal, Tangent" in TABLES[ALL]
        return
    own = TABLES[kind.name]
    default, span, text = own.get(parameter.label) or TABLES[ALL][parameter.label]
    values = parameter.default if parameter.is_vector else (parameter.default,)
    assert default == ", ".join(f"{value:g}" for value in values)
    assert span == f"{parameter.legal[0]:g} to {parameter.legal[1]:g}"
    for number, choice in enumerate(parameter.choices):
        assert f"{number} {choice}" in text


def test_tables_have_no_other_parameters() -> None:
    labels = {parameter.label for kind in KINDS.values() for parameter in kind.parameters}
    for name in (ALL, *(kind.name for kind in KINDS.values())):
        rows = set(TABLES[name]) - {name, "---", "Normal, Tangent"}
        assert rows <= labels, name
