# SPDX-License-Identifier: GPL-3.0-or-later
"""What every pytest run shares: two tiers, one temporary folder, a table of measurements."""

import os
import shutil
import sys
import tempfile
from collections.abc import Callable

import pytest

_TEMPORARY = pytest.StashKey[str]()

_exit_status = 0


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that runs both tiers."""
    parser.addoption("--nightly", action="store_true", help="run every test, slow ones too")


def pytest_configure(config: pytest.Config) -> None:
    """Put all temporary files into one folder, which is removed at the end.

    Blender leaves a folder behind whenever it ends without its own tear-down.
    """
    if not hasattr(config, "workerinput"):  # workers inherit the folder
        config.stash[_TEMPORARY] = folder = tempfile.mkdtemp(prefix="microbounce_tests_")
        os.environ["TMPDIR"] = tempfile.tempdir = folder


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is marked `nightly`, unless --nightly asks for it."""
    if config.getoption("nightly"):
        return
    left_out = [item for item in items if item.get_closest_marker("nightly")]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]


@pytest.fixture
def report(request: pytest.FixtureRequest) -> Callable[[str, str, str], None]:
    """Note (what was measured, the value, the limit) for the table at the end of the run."""
    return lambda *row: request.node.user_properties.append(("measured", row))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print the table."""
    reports = (r for rs in terminalreporter.stats.values() for r in rs if hasattr(r, "when"))
    called = [one for one in reports if one.when == "call"]
    rows = [row for one in called for name, row in one.user_properties if name == "measured"]
    if not rows:
        return
    terminalreporter.section("measured")
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for row in rows:
        line = "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True))
        terminalreporter.write_line(line.rstrip())


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Keep the status for the exit below."""
    global _exit_status
    _exit_status = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Remove the temporary folder. Leave without Blender's tear-down, where bpy 4.5 can hang."""
    folder = config.stash.get(_TEMPORARY, None)
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(_exit_status)
