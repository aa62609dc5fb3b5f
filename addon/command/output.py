# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints a subcommand's result and nothing else to standard output."""

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Iterator
from typing import TextIO


class CommandError(Exception):
    """Wrong use, or an error that the user can put right; the message names the remedy."""


@contextlib.contextmanager
def reserved_output() -> Iterator[TextIO]:
    """Yield a stream to standard output; what else is printed goes to standard error meanwhile.

    Blender's compiled parts tell of files and renders on standard output, which would spoil JSON.
    """
    sys.stdout.flush()
    saved = os.dup(1)
    os.dup2(2, 1)
    try:
        # Closed on leaving, which flushes; the copy in `saved` stays for the way back.
        with (
            open(os.dup(saved), "w", encoding="utf-8") as stream,
            contextlib.redirect_stdout(sys.stderr),
        ):
            yield stream
    finally:
        os.dup2(saved, 1)
        os.close(saved)


def emit(arguments: argparse.Namespace, data: dict[str, object], text: str) -> None:
    """Print the result: `data` where --json was given, with the subcommand's name, else `text`."""
    if arguments.json:
        text = json.dumps({"command": arguments.command} | data, indent=2)
    print(text, file=arguments.output)


def emit_error(arguments: argparse.Namespace, message: str) -> None:
    """Where --json was given, print the error as the one document; else nothing."""
    if arguments.json:
        emit(arguments, {"error": message}, "")
