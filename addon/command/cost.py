# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `cost`, which measures what accuracy costs in time in a file's scene."""

import argparse
import sys
from pathlib import Path

import bpy

from ..core.cost.options import OPTIONS, CostOption, options_of
from ..core.cost.plan import PlanError
from ..core.run import Progress
from ..cost.run import CostError, measure
from .files import add_file_argument, open_file
from .output import CommandError, emit

NAME = "cost"
HELP = "Measure which error each quality reaches in which time, beside Cycles' own materials."
EXAMPLES = (
    "",
    "--samples 128 --percentage 100 --output report",
    "--steps fitted,walk --bounces none --region 0.4,0.4,0.6,0.6",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    for option in OPTIONS:
        _add_argument(parser, option)
    parser.add_argument(
        "--region", default="", metavar="X0,Y0,X1,Y1", help="part of the picture, each from 0 to 1"
    )


def _add_argument(parser: argparse.ArgumentParser, option: CostOption) -> None:
    text = option.help.replace("%", "%%")
    if isinstance(option.default, bool):
        what = "leave Cycles' own materials out"
        parser.add_argument("--no-cycles", action="store_false", dest=option.name, help=what)
        return
    arguments = {"default": option.default or "none", "metavar": option.metavar}
    if option.choices:
        names = [name.lower() for name, _ in option.choices]
        arguments = {"default": option.default.lower(), "choices": names}
    elif not isinstance(option.default, str):
        arguments |= {"default": option.default, "type": type(option.default)}
    # The stream for the result is called `output`.
    dest = "folder" if option.name == "output" else option.name
    flag = f"--{option.name.replace('_', '-')}"
    shown = "%(default)g" if isinstance(option.default, float) else "%(default)s"
    parser.add_argument(flag, dest=dest, help=f"{text} (default: {shown})", **arguments)


def run(arguments: argparse.Namespace) -> int:
    """Measure, print the table, and return 0."""
    try:
        given = vars(arguments) | {"reference": arguments.reference.upper()}
        options = options_of(given, arguments.region)
    except PlanError as error:
        raise CommandError(str(error)) from error
    path = open_file(arguments)
    context = bpy.context
    try:
        report = measure(
            context.scene, context.view_layer, options, arguments.folder, _tell, unchanged=True
        )
    except CostError as error:
        raise CommandError(f"{path}: {error}") from error
    text = Path(report["files"]["text"]).read_text("utf-8")
    emit(arguments, {"file": str(path)} | report, f"{text}\nReport: {report['files']['page']}")
    return 0


def _tell(progress: Progress) -> None:
    left = "" if progress.left is None else f", {progress.left:.0f} s left"
    print(f"{100 * progress.part:3.0f} % {progress.text}{left}", file=sys.stderr, flush=True)
