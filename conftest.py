# SPDX-License-Identifier: GPL-3.0-or-later
"""What every pytest run of the project shares."""

import os
import sys
from collections.abc import Hashable
from pathlib import Path

import pytest

TESTS = Path(__file__).parent / "blender_tests"
WITHOUT_BLENDER = (TESTS / "tools" / "figures", TESTS / "oracle")

_exit_status = 0


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that shares tests among two runs."""
    parser.addoption(
        "--half",
        type=int,
        choices=(1, 2),
        help="run only the first or only the second of every two tests marked `once`",
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what uses no Blender as `once`, and leave out the half that was not asked for."""
    for item in items:
        if _uses_no_blender(item):
            item.add_marker("once")
    half = config.getoption("half")
    if half is None:
        return
    once = [item for item in items if item.get_closest_marker("once")]
    units = list(dict.fromkeys(map(_unit, once)))
    others = set(units[2 - half :: 2])
    left_out = {item for item in once if _unit(item) in others}
    config.hook.pytest_deselected(items=list(left_out))
    items[:] = [item for item in items if item not in left_out]


def _uses_no_blender(item: pytest.Item) -> bool:
    return any(folder in item.path.parents for folder in WITHOUT_BLENDER)


def _unit(item: pytest.Item) -> Hashable:
    """What is not torn apart: a test or, where tests are many and share costly fixtures, a file."""
    return item.path if _uses_no_blender(item) else item.nodeid


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Keep the status for the exit below."""
    global _exit_status
    _exit_status = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Leave without Blender's own tear-down, in which bpy 4.5 was seen to hang."""
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(_exit_status)
