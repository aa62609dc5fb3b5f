# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work that goes on elsewhere: how far it is, its result, its end."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeVar

Result = TypeVar("Result", covariant=True)

_POLL_SECONDS = 0.1


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    part -- from 0 to 1
    text -- what is done now
    left -- seconds that remain, None where nothing tells yet
    """

    part: float = 0.0
    text: str = "Starting"
    left: float | None = None


class RunError(RuntimeError):
    """Long work cannot begin, or failed; the message says why and what to do."""


class Run(Protocol[Result]):
    """Long work that is under way elsewhere; close() it whatever happens."""

    def advance(self) -> bool:
        """Go on, and return whether it is still under way. Raises RunError where it failed."""

    def progress(self) -> Progress:
        """Return how far it is."""

    def result(self) -> Result:
        """Return what came of it, once it is not under way. Raises RunError where it failed."""

    def close(self) -> None:
        """End it, if it has not ended, and clean up."""


def wait_for(run: Run[Result], tell: Callable[[Progress], None] = lambda progress: None) -> Result:
    """Wait until `run` has ended, tell each new state, and return the result."""
    told = None
    while run.advance():
        progress = run.progress()
        if progress != told:
            tell(progress)
            told = progress
        time.sleep(_POLL_SECONDS)
    return run.result()
