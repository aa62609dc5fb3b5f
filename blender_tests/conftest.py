# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks tests by their folders; collects what tests measure and prints it as a table."""

from collections.abc import Callable
from pathlib import Path

import pytest

HERE = Path(__file__).parent
WITHOUT_BLENDER = ("figures", "oracle")

_ROWS: list[tuple[str, str, str]] = []


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what uses no Blender."""
    for item in items:
        if item.path.relative_to(HERE).parts[0] in WITHOUT_BLENDER:
            item.add_marker("plain")


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
