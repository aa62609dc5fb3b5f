# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `blender FILE --command microbounce SUBCOMMAND ...`.

A subcommand is a module with `NAME`, `HELP` (a sentence), `EXAMPLES` (lines after the program's
name), `add_arguments(parser)` and `run(arguments) -> int`, listed in SUBCOMMANDS. It hands its
result to `output.emit` and raises CommandError for what the user has to put right.
"""

import argparse
import sys

from ..core import VERSION
from . import check, cost
from .output import CommandError, emit_error, reserved_output

SUBCOMMANDS = (check, cost)

PROGRAM = "blender FILE --command microbounce"

_EPILOG = """\
FILE may be left out and given after the subcommand as --file FILE. Nothing is saved unless --save
or --save-as says so.

exit codes: 0 all is well, 1 something was found, 2 wrong use or an error
"""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command."""
    made = argparse.ArgumentParser(
        prog=PROGRAM,
        description="Checks and changes Microbounce materials without a window.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("--version", action="version", version=f"Microbounce {VERSION}")
    choices = made.add_subparsers(title="subcommands", metavar="SUBCOMMAND", required=True)
    for module in SUBCOMMANDS:
        examples = "\n".join(
            f"  {PROGRAM} {module.NAME} {line}".rstrip() for line in module.EXAMPLES
        )
        sub = choices.add_parser(
            module.NAME,
            help=module.HELP,
            description=module.HELP,
            epilog=f"examples:\n{examples}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        sub.add_argument(
            "--json", action="store_true", help="print one JSON document, nothing else"
        )
        module.add_arguments(sub)
        sub.set_defaults(run=module.run, command=module.NAME)
    return made


def main(argv: list[str]) -> int:
    """Run what `argv`, the arguments after "microbounce", asks for; return the exit code.

    0 is fine, 1 means that something was found, 2 is wrong use or an error.
    """
    try:
        arguments = parser().parse_args(argv)
    except SystemExit as leave:  # argparse has printed the help or what is wrong
        return int(leave.code or 0)
    with reserved_output() as arguments.output:
        try:
            return arguments.run(arguments)
        except CommandError as error:
            print(f"Error: {error}", file=sys.stderr)
            emit_error(arguments, str(error))
            return 2
