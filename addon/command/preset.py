# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `preset`, which gives a material the values of a preset."""

import argparse
import sys

from ..core.presets.catalogue import finishes, presets
from ..material.group import GROUP_ERRORS
from ..material.node import MaterialError
from ..presets.apply import apply_preset
from ..presets.user import load_user_presets
from .files import add_file_argument, add_save_arguments, check_target, open_file, save_file, saved
from .names import named_item, named_material
from .output import CommandError, emit

NAME = "preset"
HELP = "Give a material the values of a preset."
EXAMPLES = (
    "gold --material Ring --save-as new.blend",
    "conductor/gold --material Ring --finish brushed --save",
    "user/conductor/mine --material Ring --save",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    parser.add_argument(
        "name",
        metavar="NAME",
        help="the preset, such as gold, conductor/gold or user/conductor/mine",
    )
    parser.add_argument("--material", required=True, help="the material that gets the values")
    parser.add_argument("--finish", help="a finish on top, such as brushed")
    add_file_argument(parser)
    add_save_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Apply, save where that was asked, and print what was done."""
    own, problems = load_user_presets()
    for problem in problems:
        print(f"Left out: {problem}", file=sys.stderr)
    chosen = named_item(arguments.name, (*presets(), *own), "preset")
    finish = arguments.finish and named_item(arguments.finish, finishes(), "finish")
    check_target(arguments)
    path = open_file(arguments)
    material = named_material(arguments.material)
    try:
        left = apply_preset(material, chosen, finish)
    except (MaterialError, *GROUP_ERRORS) as error:
        raise CommandError(str(error)) from error
    target = save_file(arguments)
    data = {
        "file": str(path),
        "material": material.name,
        "preset": chosen.identifier,
        "finish": finish.identifier if finish else None,
        "left": left,
        "saved": target,
    }
    name = f"{chosen.name}, {finish.name}" if finish else chosen.name
    lines = [f"{material.name}: {name}"]
    if left:
        lines.append(f"Left as they were, since they are linked: {', '.join(left)}")
    emit(arguments, data, "\n".join([*lines, saved(target)]))
    return 0
