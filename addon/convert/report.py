# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells users what a conversion does to each node, or would do, or why not."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Entry:
    """One node, or one material as a whole.

    node   -- its name, "" for the material
    source -- what it is, such as "Glossy BSDF"
    target -- what it becomes, such as "Microbounce Conductor"; "" if it stays
    notes  -- what will not look the same
    reason -- why it stays, with the remedy; "" if it does not
    """

    node: str
    source: str
    target: str = ""
    notes: tuple[str, ...] = ()
    reason: str = ""

    @property
    def text(self) -> str:
        """The entry in one line."""
        if not self.node:
            return self.reason
        name = self.node if self.node == self.source else f"{self.node} ({self.source})"
        if not self.target:
            return f"{name} stays. {self.reason}"
        return ". ".join([f"{name}: {self.target}", *self.notes])


@dataclass(frozen=True)
class Conversion:
    """What becomes of one material."""

    material: str
    entries: tuple[Entry, ...] = field(default=())

    @property
    def converted(self) -> tuple[Entry, ...]:
        """The nodes that become others."""
        return tuple(entry for entry in self.entries if entry.target)

    @property
    def approximated(self) -> tuple[Entry, ...]:
        """Those of them that will not look quite the same."""
        return tuple(entry for entry in self.converted if entry.notes)

    @property
    def refused(self) -> tuple[Entry, ...]:
        """The nodes that stay though they are of a type that can be converted."""
        return tuple(entry for entry in self.entries if entry.reason)

    @property
    def lines(self) -> list[str]:
        """A line for each entry."""
        return [f"{self.material}: {e.text}" if e.node else e.text for e in self.entries]
