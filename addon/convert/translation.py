# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of a node, translated for a node of another type."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

from ..material.sockets import SocketValue, value_text
from .formula import Formula
from .state import State


class NotConvertibleError(Exception):
    """The node has no counterpart; the message says why, and the remedy."""


class Through(NamedTuple):
    """A change of a link: it gains nodes for `formula`, or loses those for `undoes`."""

    formula: Formula
    undoes: Formula


@dataclass
class Translation:
    """Data for a node of another type. Inputs that it leaves out stay as they are.

    target   -- the kind of a node of ours, or the type of a native one
    values   -- values of its inputs by name
    settings -- its properties by identifier
    carried  -- inputs whose links and animation go along: their names to the target's
    through  -- formulas for links of some of these; the others go along unchanged
    notes    -- differences in look, for users
    """

    target: str
    values: dict[str, SocketValue] = field(default_factory=dict)
    settings: dict[str, SocketValue] = field(default_factory=dict)
    carried: dict[str, str] = field(default_factory=dict)
    through: dict[str, Through] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def carry(self, source: State, *names: str, **renamed: str) -> None:
        """Take inputs over unchanged: `names` are the same on both, `renamed` are new=old."""
        pairs = {name: name for name in names}
        pairs |= {old: new.replace("_", " ") for new, old in renamed.items()}
        for old, new in pairs.items():
            if old in source.values:
                self.carried[old] = new
                self.values[new] = source.values[old]

    def derive(
        self, source: State, name: str, target: str, formula: Formula, undoes: Formula
    ) -> None:
        """Take an input over by a formula. A link goes through nodes for it.

        `undoes` is the formula of the other direction.
        """
        self.values[target] = formula(source.values[name])
        if name in source.varying:
            self.carried[name] = target
            self.through[name] = Through(formula, undoes)


class Family(NamedTuple):
    """A type of native node with its translations.

    idname  -- the type
    forward -- its state to the data of a node of ours; raises NotConvertibleError
    back    -- a state of ours, and the native state that it was made from or None, to native data;
               raises NotConvertibleError
    """

    idname: str
    forward: Callable[[State], Translation]
    back: Callable[[State, State | None], Translation]


def need_fixed(source: State, name: str, why: str) -> None:
    """Raise NotConvertibleError if input `name` is linked or animated."""
    if name in source.varying:
        raise NotConvertibleError(
            f"{name} is linked or animated, and {why}: unlink it and set a value"
        )


def need_value(source: State, name: str, why: str, *allowed: SocketValue) -> None:
    """Raise NotConvertibleError if input `name` is not fixed at one of the values `allowed`."""
    if source.is_fixed(name, *allowed):
        return
    given = "linked or animated" if name in source.varying else value_text(source.values[name])
    raise NotConvertibleError(f"{name} is {given}: {why}. Set it to {value_text(allowed[0])}")
