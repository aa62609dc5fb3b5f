# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `analyse`, which proposes Quality and Max Bounces of every material."""

import argparse

import bpy

from ..analysis.analyse import Analysis, analyse
from ..core.analysis.picture_error import DEFAULT_TOLERANCE, percent
from ..core.analysis.proposal import Option
from .files import add_file_argument, open_file
from .output import CommandError, emit

NAME = "analyse"
HELP = (
    "Propose the cheapest Quality of every material that keeps the picture within a tolerance. "
    "Exit code 1: a change is proposed, or no choice is within the tolerance."
)
EXAMPLES = ("", "--tolerance 0.02", "--json")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    add_tolerance_argument(parser)


def add_tolerance_argument(parser: argparse.ArgumentParser) -> None:
    """Add `--tolerance`."""
    parser.add_argument(
        "--tolerance",
        type=float,
        default=DEFAULT_TOLERANCE,
        metavar="T",
        help="how far off the picture may be, as image L2, above 0 to 1 (%(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the table; 1 where a change is proposed or no choice is enough, else 0."""
    path = open_file(arguments)
    analysis = analysed(arguments)
    emit(arguments, {"file": str(path)} | analysis.as_dict(), "\n".join(table(analysis)))
    return 1 if analysis.changes or not analysis.within_tolerance else 0


def analysed(arguments: argparse.Namespace) -> Analysis:
    """Return the analysis of the open scene; raises CommandError for a bad tolerance."""
    try:
        return analyse(bpy.context, arguments.tolerance)
    except ValueError as error:
        raise CommandError(str(error)) from error


def table(analysis: Analysis) -> list[str]:
    """Return the lines of the table for people."""
    if not analysis.rows:
        return ["No object of the scene shows a Microbounce material"]
    lines = [] if analysis.has_camera else ["There is no camera to find shares: all are equal"]
    for row in analysis.rows:
        one = row.proposal
        change = f"{one.now} to {one.then}" if one.changes else f"{one.now}, stays"
        lines.append(f"{row.name} ({percent(one.share)} of the picture): {change}")
        lines.append(f"    off by {percent(one.error_now)}, then {percent(one.error_then)}")
        lines += [f"    {text}" for text in (one.reason, *row.notes)]
        lines += [f"        {_step(option)}" for option in one.steps]
    lines.append(
        f"Picture: off by {percent(analysis.error_now)}, then {percent(analysis.error_then)}; "
        f"time of a sample {analysis.time_ratio:.2f} times that of now"
    )
    if not analysis.within_tolerance:
        lines.append(
            f"No choice of steps is within the tolerance of {percent(analysis.tolerance)}: "
            f"{percent(analysis.error_then)} are left"
        )
    return lines


def _step(option: Option) -> str:
    """Return the line of a Quality, in columns."""
    error, loss = percent(option.error), percent(option.loss)
    return (
        f"{option.choice!s:20}{error:>13} off {loss:>13} of its light lost, time {option.cost:.2f}"
    )
