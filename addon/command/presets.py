# SPDX-License-Identifier: GPL-3.0-or-later
"""The subcommand `presets`, which lists the measured materials, the finishes, the user's own."""

import argparse

from ..core.kinds import KINDS
from ..core.presets.catalogue import finishes, presets, problems
from ..core.presets.files import Finish, Preset
from ..core.presets.user_files import is_users
from ..presets.user import load_user_presets
from .output import CommandError, emit

NAME = "presets"
HELP = "List presets and finishes: those that the extension brings, and your own (user/...)."
EXAMPLES = ("", "--kind conductor --search gold", "--kind finish", "--json")

_FINISH = "finish"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of this subcommand."""
    kinds = [*(kind.lower() for kind in KINDS), _FINISH]
    parser.add_argument("--kind", choices=kinds, help="only these")
    parser.add_argument(
        "--search",
        metavar="WORDS",
        default="",
        help="only where name, tags or text hold all",
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the list; 1 where nothing is in it, or one of the user's was left out."""
    if problems():
        raise CommandError(" ".join(problems()))
    own, wrong = load_user_presets()
    words = arguments.search.casefold().split()
    items = [
        item
        for item in (*presets(), *finishes(), *own)
        if arguments.kind in (None, item.kind.lower() if isinstance(item, Preset) else _FINISH)
        and all(word in _searched(item) for word in words)
    ]
    width = max((len(item.identifier) for item in items), default=0)
    lines = [f"{item.identifier:{width}}  {item.name}: {item.description}" for item in items]
    lines = lines or ["No preset is like that: search for less"]
    lines += [f"Left out: {problem}" for problem in wrong]
    data = {"presets": [_as_data(item) for item in items], "left_out": wrong}
    emit(arguments, data, "\n".join(lines))
    return 0 if items and not wrong else 1


def _tags(item: Preset | Finish) -> tuple[str, ...]:
    return item.tags if isinstance(item, Preset) else ()


def _searched(item: Preset | Finish) -> str:
    return " ".join((item.identifier, item.name, item.description, *_tags(item))).casefold()


def _as_data(item: Preset | Finish) -> dict[str, object]:
    return {
        "identifier": item.identifier,
        "kinds": [item.kind] if isinstance(item, Preset) else list(item.kinds),
        "own": is_users(item),
        "name": item.name,
        "description": item.description,
        "tags": list(_tags(item)),
        "values": dict(item.values),
        "source": {
            "title": item.source.title,
            "url": item.source.url,
            "licence": item.source.licence,
        },
    }
