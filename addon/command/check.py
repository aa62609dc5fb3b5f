# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `check`, which tells whether a file will render on a farm as it does here."""

import argparse

import bpy

from ..core.finding import by_level, counts, worst
from ..nodes.farm.check import farm_findings
from .files import add_file_argument, open_file
from .output import emit

NAME = "check"
HELP = "Check that a file renders without the extension, as on a render farm."
EXAMPLES = ("", "--json", "--prove")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print what was found; 1 where that is an error or a warning, else 0."""
    path = open_file(arguments)
    findings = by_level(farm_findings(bpy.context.scene))
    found = worst(findings) in ("error", "warning")
    data = {
        "file": str(path),
        "ok": not found,
        "findings": [finding.as_dict() for finding in findings],
    }
    lines = [finding.as_text() for finding in findings]
    emit(arguments, data, "\n".join([*lines, f"{path}: {counts(findings)} found"]))
    return 1 if found else 0
