# SPDX-License-Identifier: GPL-3.0-or-later
"""What a check found: how bad, about what, what is wrong, and what to do."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass

# From the worst on. An error spoils the picture, a warning may, a note is worth knowing.
LEVELS = ("error", "warning", "note")


@dataclass(frozen=True)
class Finding:
    """One thing that a check found.

    level   -- one of LEVELS
    subject -- what it is about, such as "Material 'Gold'"
    message -- what is wrong, a sentence
    remedy  -- what to do, a sentence; "" if nothing needs doing
    """

    level: str
    subject: str
    message: str
    remedy: str = ""

    def __post_init__(self) -> None:
        if self.level not in LEVELS:
            raise ValueError(f"The level is {self.level!r}: use one of {', '.join(LEVELS)}")

    def as_dict(self) -> dict[str, str]:
        """Return the finding as plain data; its keys are the names of the fields."""
        return asdict(self)

    @property
    def text(self) -> str:
        """The finding as one line for people, without its level."""
        return f"{self.subject}: {self.message} {self.remedy}".rstrip()

    def as_text(self) -> str:
        """Return the finding as one line for people."""
        return f"{self.level.title()}: {self.text}"


def worst(findings: Iterable[Finding]) -> str:
    """Return the worst level among `findings`, "" if there are none."""
    levels = {finding.level for finding in findings}
    return next((level for level in LEVELS if level in levels), "")


def by_level(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return `findings` with the worst first, otherwise in their order."""
    return tuple(sorted(findings, key=lambda finding: LEVELS.index(finding.level)))


def counts(findings: Iterable[Finding]) -> str:
    """Return how many there are of each level, as "2 errors, 1 note"; "nothing" without any."""
    levels = [finding.level for finding in findings]
    parts = []
    for level in LEVELS:
        number = levels.count(level)
        if number:
            parts.append(f"{number} {level}{'' if number == 1 else 's'}")
    return ", ".join(parts) or "nothing"
