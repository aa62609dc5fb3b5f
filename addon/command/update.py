# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `update`, which brings materials of older versions up to date."""

import argparse
from dataclasses import asdict

from ..material.group import GROUP_ERRORS
from ..material.update import Update, old_groups, update_materials
from .files import (
    add_dry_run_argument,
    add_file_argument,
    add_save_arguments,
    check_target,
    open_file,
    save_file,
    saved,
)
from .output import CommandError, emit

NAME = "update"
HELP = "Give materials of older versions today's node groups."
EXAMPLES = ("--dry-run", "--save", "--save-as updated.blend")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    add_dry_run_argument(parser)
    add_save_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Update, or say what is old; 1 where something was lost or stays old, or would be updated."""
    check_target(arguments)
    path = open_file(arguments)
    try:
        old = [group.name for group in old_groups()]
        done = Update() if arguments.dry_run else update_materials()
    except GROUP_ERRORS as error:
        raise CommandError(str(error)) from error
    target = save_file(arguments)
    data = {"file": str(path), "dry_run": arguments.dry_run, "old": old}
    lines = [f"Older version: {name}" for name in old]
    if not arguments.dry_run:
        lines += [f"Lost: {text}" for text in done.lost] + [f"Stays: {text}" for text in done.stay]
        lines += [f"Nodes updated: {done.nodes}", saved(target)]
    elif not old:
        lines.append("All Microbounce materials are of this version")
    emit(arguments, data | asdict(done) | {"saved": target}, "\n".join(lines))
    return 1 if done.lost or done.stay or (arguments.dry_run and old) else 0
