# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `cost`, which measures what accuracy costs in time in a file's scene."""

import argparse
import sys
from pathlib import Path

import bpy

from ..core.cost.plan import (
    REFERENCES,
    Options,
    PlanError,
    listed,
    parse_numbers,
    parse_region,
    parse_steps,
)
from ..core.run import Progress
from ..cost.run import OUTPUT, CostError, measure
from .files import add_file_argument, open_file
from .output import CommandError, emit

NAME = "cost"
HELP = "Measure which error each quality reaches in which time, beside Cycles' own materials."
EXAMPLES = (
    "",
    "--samples 128 --percentage 100 --output report",
    "--steps fitted,walk --bounces none --region 0.4,0.4,0.6,0.6",
)

_DEFAULT = Options()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    add = parser.add_argument
    add(
        "--samples",
        type=int,
        default=_DEFAULT.samples,
        metavar="N",
        help="of each picture, 0 for the scene's (default: %(default)s)",
    )
    add(
        "--percentage",
        type=int,
        default=_DEFAULT.percentage,
        metavar="P",
        help="of the scene's width and height, 0 for the scene's own (default: %(default)s)",
    )
    add(
        "--steps",
        default=listed(_DEFAULT.steps),
        metavar="LIST",
        help="qualities, with commas between, or none (default: %(default)s)",
    )
    add(
        "--bounces",
        default=listed(_DEFAULT.bounces),
        metavar="LIST",
        help="limits of the bounces in Walk, or none (default: %(default)s)",
    )
    add("--walks", default="none", metavar="LIST", help="numbers of walks (default: none)")
    add("--kernels", default="none", metavar="LIST", help="radii of Walk's lobe (default: none)")
    add("--no-cycles", action="store_true", help="leave Cycles' own materials out")
    add("--region", metavar="X0,Y0,X1,Y1", help="part of the picture, each from 0 to 1")
    add(
        "--rounds",
        type=int,
        default=_DEFAULT.rounds,
        metavar="N",
        help="renders of each, with seeds of their own (default: %(default)s)",
    )
    add(
        "--error",
        type=float,
        default=100 * _DEFAULT.error,
        metavar="PERCENT",
        help="target that times are for (default: %(default)g)",
    )
    add(
        "--reference",
        choices=[name.lower() for name in REFERENCES],
        default=_DEFAULT.reference.lower(),
        help="what pictures are compared with (default: %(default)s)",
    )
    add(
        "--reference-samples",
        type=int,
        default=_DEFAULT.reference_samples,
        metavar="N",
        help="of the reference, 0 for 16 times those of a picture (default: %(default)s)",
    )
    add(
        "--output",
        dest="folder",  # `output` is the stream for the result
        default=OUTPUT,
        metavar="FOLDER",
        help="for cost.html, .csv, .json and .svg (default: %(default)s, beside the file)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Measure, print the table, and return 0."""
    try:
        options = _options(arguments)
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


def _options(arguments: argparse.Namespace) -> Options:
    return Options(
        samples=arguments.samples,
        percentage=arguments.percentage,
        steps=parse_steps(arguments.steps),
        bounces=parse_numbers(arguments.bounces),
        walks=parse_numbers(arguments.walks),
        kernels=parse_numbers(arguments.kernels, float),
        baselines=not arguments.no_cycles,
        rounds=arguments.rounds,
        reference=arguments.reference.upper(),
        reference_samples=arguments.reference_samples,
        error=arguments.error / 100.0,
        region=parse_region(arguments.region) if arguments.region else None,
    )


def _tell(progress: Progress) -> None:
    left = "" if progress.left is None else f", {progress.left:.0f} s left"
    print(f"{100 * progress.part:3.0f} % {progress.text}{left}", file=sys.stderr, flush=True)
