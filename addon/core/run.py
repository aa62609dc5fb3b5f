# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work, elsewhere or in small pieces: how far it is, its result, its end."""

import time
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

Result = TypeVar("Result", covariant=True)

# Work in small pieces: it yields the part that is done, from 0 to 1, and returns what came of it.
Pieces = Generator[float, None, Result]

_POLL_SECONDS = 0.1
_SLICE_SECONDS = 0.3


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    part -- from 0 to 1
    text -- what is done now
    left -- seconds that remain, None if nothing tells yet
    """

    part: float = 0.0
    text: str = "Starting"
    left: float | None = None


class RunError(RuntimeError):
    """Long work cannot begin, or failed; the message says why and what to do."""


class Run(Protocol[Result]):
    """Long work that is under way; close() it whatever happens."""

    def advance(self) -> bool:
        """Go on, and return whether it is still under way. Raises RunError if it failed."""

    def progress(self) -> Progress:
        """Return how far it is."""

    def result(self) -> Result:
        """Return what came of it, once it is not under way. Raises RunError if it failed."""

    def close(self) -> None:
        """End it, if it has not ended, and clean up."""


def wait_for(run: Run[Result], tell: Callable[[Progress], None] = lambda progress: None) -> Result:
    """Wait until `run` has ended, tell each new state, the last one too, and return the result."""
    told = None
    going_on = True
    while going_on:
        going_on = run.advance()
        progress = run.progress()
        if progress != told:
            tell(progress)
            told = progress
        if going_on:
            time.sleep(_POLL_SECONDS)
    return run.result()


def done_at_once(
    pieces: Pieces[Result], tell: Callable[[float], None] = lambda part: None
) -> Result:
    """Do all of a piecewise work, tell each part that is done, and return the result."""
    while True:
        try:
            part = next(pieces)
        except StopIteration as end:
            return end.value
        tell(part)


class PiecewiseRun(Generic[Result]):
    """A run of work that is done here, a slice of time at each advance()."""

    def __init__(self, pieces: Pieces[Result]) -> None:
        """Begin with the first piece at the first advance()."""
        self._pieces, self._part = pieces, 0.0
        self._result: Result | None = None

    def advance(self) -> bool:
        """Work for a slice of time, and return whether there is more to do."""
        end = time.monotonic() + _SLICE_SECONDS
        while time.monotonic() < end:
            try:
                self._part = next(self._pieces)
            except StopIteration as stop:
                self._result = stop.value
                return False
        return True

    def progress(self) -> Progress:
        """Return the part that is done."""
        return Progress(self._part, f"{100.0 * self._part:.0f} %")

    def result(self) -> Result:
        """Return what came of it, once advance() has said that nothing is left to do."""
        return self._result

    def close(self) -> None:
        """Do no more."""
        self._pieces.close()
