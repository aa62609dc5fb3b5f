# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `check`, which tells whether a file will render on a farm as it does here."""

import argparse
import sys
from dataclasses import asdict

import bpy

from ..core.finding import by_level, counts, worst
from ..farm.check import farm_findings
from ..farm.proof import TIME_LIMIT, ProofError, prove
from .files import add_file_argument, open_file
from .output import CommandError, emit

NAME = "check"
HELP = "Check that a file renders without the extension, as on a render farm."
EXAMPLES = ("", "--json", "--prove")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    add_file_argument(parser)
    parser.add_argument(
        "--prove",
        action="store_true",
        help="also render it small, with and without the extension, and compare",
    )
    parser.add_argument(
        "--time-limit",
        type=_seconds,
        default=TIME_LIMIT,
        metavar="SECONDS",
        help="what each of these renders may take (default: %(default)g)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print what was found; 1 where that is an error or a warning, else 0."""
    path = open_file(arguments)
    findings = farm_findings(bpy.context.scene)
    proof = None
    if arguments.prove:
        try:
            proof = prove(path, arguments.time_limit, lambda now: print(now.text, file=sys.stderr))
        except ProofError as error:
            raise CommandError(f"{path} was not proved. {error}") from error
        findings += proof.findings(path)
    findings = by_level(findings)
    found = worst(findings) in ("error", "warning")
    data = {
        "file": str(path),
        "ok": not found,
        "findings": [finding.as_dict() for finding in findings],
        "proof": proof and {"ok": proof.ok} | asdict(proof),
    }
    lines = [finding.as_text() for finding in findings]
    if proof is not None and proof.difference == 0.0 and proof.ok:
        lines.append("Proof: it renders the same without the extension, to the last bit.")
    emit(arguments, data, "\n".join([*lines, f"{path}: {counts(findings)} found"]))
    return 1 if found else 0


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is no time: give a number of seconds above 0")
    return value
