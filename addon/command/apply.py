# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `apply`, which sets what `analyse` proposes."""

import argparse

import bpy

from ..analysis.analyse import apply_analysis
from .analyse import add_tolerance_argument, analysed, table
from .files import add_file_argument, add_save_arguments, check_target, open_file, save_file, saved
from .output import emit

NAME = "apply"
HELP = (
    "Set the Quality and Max Bounces that `analyse` proposes. "
    "Exit code 1: the picture is not within the tolerance even so, or something could not be set."
)
EXAMPLES = ("--save-as FAST.blend", "--tolerance 0.02 --save")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    add_tolerance_argument(parser)
    add_save_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Set the values, print the table, and save where that was asked.

    It is 1 where the picture is not within the tolerance even so, or something was left, else 0.
    """
    check_target(arguments)
    path = open_file(arguments)
    analysis = analysed(arguments)
    done, left = apply_analysis(bpy.context, analysis)
    target = save_file(arguments)
    lines = [*table(analysis), f"{len(done)} materials set"]
    lines += [f"Changed since the analysis and left: {', '.join(left)}"] if left else []
    lines.append(saved(target))
    data = {"file": str(path), "saved": target, "set": done, "left": left} | analysis.as_dict()
    emit(arguments, data, "\n".join(lines))
    return 0 if analysis.within_tolerance and not left else 1
