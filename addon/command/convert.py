# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `convert`, which converts Cycles' materials to ours and back."""

import argparse
from dataclasses import asdict
from functools import partial

from ..convert import TO_NATIVE, TO_OURS, Conversion, needed_groups, plan, to_microbounce, to_native
from ..material.graph import surface_materials
from ..material.group import GROUP_ERRORS
from .files import (
    add_dry_run_argument,
    add_file_argument,
    add_save_arguments,
    check_target,
    open_file,
    save_file,
    saved,
)
from .names import named_material
from .output import CommandError, emit

NAME = "convert"
HELP = "Convert Cycles' materials to Microbounce, or back."
EXAMPLES = (
    "--to microbounce --dry-run",
    "--to microbounce --save-as converted.blend",
    "--to native --material Ring --save",
)

_WAYS = {"microbounce": TO_OURS, "native": TO_NATIVE}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    parser.add_argument("--to", required=True, choices=list(_WAYS), help="what they become")
    parser.add_argument(
        "--material", action="append", help="only this one (may be given several times)"
    )
    add_file_argument(parser)
    add_dry_run_argument(parser)
    add_save_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Convert, or plan it, and print every node; 1 where nodes stay, or would be converted."""
    check_target(arguments)
    path = open_file(arguments)
    names = arguments.material
    materials = [named_material(name) for name in names] if names else surface_materials()
    direction = _WAYS[arguments.to]
    try:
        if arguments.dry_run:
            convert = partial(plan, direction=direction)
        elif direction == TO_OURS:
            convert = partial(to_microbounce, groups=needed_groups(materials))
        else:
            convert = to_native
        done = [convert(material) for material in materials]
    except GROUP_ERRORS as error:
        raise CommandError(str(error)) from error
    converted = sum(len(conversion.converted) for conversion in done)
    refused = sum(len(conversion.refused) for conversion in done)
    target = save_file(arguments)
    data = {
        "file": str(path),
        "to": arguments.to,
        "dry_run": arguments.dry_run,
        "converted": converted,
        "refused": refused,
        "materials": [asdict(conversion) for conversion in done],
        "saved": target,
    }
    emit(arguments, data, "\n".join(_lines(done, converted, refused, arguments.dry_run, target)))
    return 1 if refused or (arguments.dry_run and converted) else 0


def _lines(
    done: list[Conversion], converted: int, refused: int, dry_run: bool, target: str
) -> list[str]:
    lines = [line for conversion in done for line in conversion.lines]
    would = "would be converted" if dry_run else "converted"
    lines.append(f"Nodes {would}: {converted}; that stay: {refused}")
    return lines if dry_run else [*lines, saved(target)]
