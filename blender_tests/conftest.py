# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects what the picture tests measure and prints it as a table when all have run."""

from collections.abc import Callable

import pytest

_ROWS: list[tuple[str, str, str]] = []


@pytest.fixture
def report() -> Callable[[str, str, str], None]:
    """Note (what was measured, the value, the limit) for the table."""
    return lambda *row: _ROWS.append(row)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print the table."""
    if not _ROWS:
        return
    terminalreporter.section("measured")
    widths = [max(len(row[column]) for row in _ROWS) for column in range(3)]
    for row in _ROWS:
        line = "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True))
        terminalreporter.write_line(line.rstrip())
