# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that is over after some looks at it."""

from addon.core.run import Progress, RunError


class FakeRun:
    """Counts how often it was closed; with `error` it fails at its end."""

    def __init__(self, steps: int, result: object = None, error: str = "") -> None:
        """Last for `steps` calls of advance()."""
        self._steps, self._result, self._error = steps, result, error
        self._done = self.closed = 0

    def advance(self) -> bool:
        """Go on by a step."""
        going_on = self._done < self._steps
        self._done += going_on
        return going_on

    def progress(self) -> Progress:
        """Return the steps done."""
        return Progress(self._done / self._steps, f"step {self._done}")

    def result(self) -> object:
        """Return the result, or fail."""
        if self._error:
            raise RunError(self._error)
        return self._result

    def close(self) -> None:
        """Count the call."""
        self.closed += 1
