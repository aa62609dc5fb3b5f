# SPDX-License-Identifier: GPL-3.0-or-later
"""A converted node's record of the node it was made from, so that the way back loses nothing."""

import json
from dataclasses import asdict, dataclass, replace

import bpy

from .state import State
from .translation import Translation

RECORD_KEY = "microbounce_converted_from"


@dataclass
class Link:
    """A link into an input that the converted node does not have.

    socket -- the input's name
    node   -- the name of the node that it comes from
    output -- the identifier of that node's output
    muted  -- whether the link is muted
    """

    socket: str
    node: str
    output: str
    muted: bool


@dataclass
class Record:
    """Kept on a converted node.

    was     -- the state of the node that it was made from
    links   -- that node's links that had no counterpart
    made    -- the state of the converted node when it was made; later differences are the user's
    fresh   -- whether a node without a record becomes `made` too
    """

    was: State
    links: list[Link]
    made: State
    fresh: bool


def read_record(node: bpy.types.Node) -> Record | None:
    """Return the record that `node` keeps; None if it has none, or one that cannot be read."""
    text = node.get(RECORD_KEY)
    if not isinstance(text, str):
        return None
    try:
        data = json.loads(text)
        return Record(
            was=State(**data["was"]),
            links=[Link(**link) for link in data["links"]],
            made=State(**data["made"]),
            fresh=data["fresh"],
        )
    except (ValueError, TypeError, KeyError):  # edited by hand, or by another version
        return None


def write_record(node: bpy.types.Node, record: Record) -> None:
    """Keep `record` on `node`."""
    node[RECORD_KEY] = json.dumps(asdict(record))


def merged(then: Translation, now: Translation, was: State) -> Translation:
    """Return `was` as a translation, with the changes from `then` to `now`.

    `then` translates the node as it was made from `was`, `now` as it is now.
    """
    made = replace(now, values=was.values.copy(), settings=was.settings.copy())
    for old, new, kept in (
        (then.values, now.values, made.values),
        (then.settings, now.settings, made.settings),
    ):
        kept |= {name: value for name, value in new.items() if value != old.get(name)}
    return made
