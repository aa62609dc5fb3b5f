# SPDX-License-Identifier: GPL-3.0-or-later
"""Proves by rendering that a file needs no extension.

Two other Blenders render the file small. One has the extension, which compiles the shaders again;
one has the file alone. The pictures have to be the same.
"""

import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..child_blender import ChildBlender
from ..core.finding import Finding
from ..core.run import Progress, RunError, wait_for

# A part of the picture's light. The same shader gives the same bits, unless Blender 4.5 sums smooth
# normals in another order: their last bits move some random walks.
TOLERANCE = 0.02
TIME_LIMIT = 300.0  # seconds, of each render


class ProofError(RunError):
    """The file could not be rendered; the message says in which Blender and why."""


@dataclass(frozen=True)
class Proof:
    """The result of the comparison.

    difference -- mean distance of the pixels, over the mean of the picture with the extension
    brightness -- that mean, over RGB
    seconds    -- of both renders together, with the start of their Blenders
    """

    difference: float
    brightness: float
    seconds: float

    @property
    def ok(self) -> bool:
        """Whether the pictures are the same, and show something."""
        return self.brightness > 0.0 and self.difference <= TOLERANCE

    def findings(self, path: Path) -> list[Finding]:
        """Return what is wrong with the file `path`; nothing if the pictures are the same."""
        subject = f"File '{path.name}'"
        if not self.brightness > 0.0:
            message = "Its picture is black or not a number, which proves nothing."
            return [Finding("warning", subject, message, "Check camera and lights of the scene.")]
        if self.difference == 0.0:
            return []
        if self.ok:
            message = f"Both renders differ by {self.difference:.2%} of the light, as noise does."
            return [Finding("note", subject, message)]
        message = (
            f"Without the extension it renders differently: {self.difference:.1%} of the light, "
            f"where {TOLERANCE:.0%} is allowed."
        )
        return [Finding("error", subject, message, "Fix the other findings, and save again.")]


class ProofRun:
    """A proof that is under way; close() it whatever happens, or use it with `with`.

    The open file is left alone.
    """

    def __init__(self, path: Path, time_limit: float = TIME_LIMIT) -> None:
        """Start to prove the saved file `path`. Each render may take `time_limit` seconds.

        Raises ProofError if none can begin.
        """
        self._path, self._limit = path, time_limit
        self._begin = time.monotonic()
        try:
            self._folder = Path(tempfile.mkdtemp(prefix="microbounce_"))
        except OSError as error:
            raise ProofError(f"No folder for temporary files: {error}. Make room") from error
        self._waiting = ["with", "without"]
        self._child: ChildBlender | None = None
        try:
            self._start_next()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "ProofRun":
        """Return itself."""
        return self

    def __exit__(self, *error: object) -> None:
        """End it, if it has not ended."""
        self.close()

    def advance(self) -> bool:
        """Start the second render once the first has ended; return whether one is under way.

        Raises ProofError if one fails or takes too long.
        """
        if self._child.running:
            if time.monotonic() - self._child_begin > self._limit:
                raise ProofError(
                    f"The render {self._which} the extension took longer than {self._limit:g} "
                    "seconds: allow more, or hide what is heavy"
                )
            return True
        reason = self._child.failure()
        if reason:
            raise ProofError(f"The render {self._which} the extension failed: {reason}")
        if not self._waiting:
            return False
        self._start_next()
        return True

    def progress(self) -> Progress:
        """Return how far it is."""
        number = 2 - len(self._waiting)
        return Progress((number - 1) / 2, f"Rendering {self._which} the extension ({number} of 2)")

    def result(self) -> Proof:
        """Compare the pictures, once nothing is under way."""
        import numpy

        ours, alone = (
            numpy.fromfile(target, dtype=numpy.float32).reshape(-1, 4)[:, :3].astype(numpy.float64)
            for target in (self._folder / "1", self._folder / "2")
        )
        brightness = float(ours.mean())
        distance = float(numpy.abs(ours - alone).mean())
        difference = distance / brightness if brightness > 0.0 else distance
        return Proof(difference, brightness, time.monotonic() - self._begin)

    def close(self) -> None:
        """End what is under way, and remove the temporary files."""
        if self._child is not None:
            self._child.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _start_next(self) -> None:
        if self._child is not None:
            self._child.close()
        number = 3 - len(self._waiting)
        self._which = self._waiting.pop(0)
        self._child_begin = time.monotonic()
        arguments = [str(self._path), str(self._folder / str(number)), self._which]
        folder = self._folder / f"user_{number}"
        try:
            self._child = ChildBlender("farm.small_render", arguments, folder)
        except OSError as error:
            reason = f"The Blender {self._which} the extension does not start: {error}"
            raise ProofError(reason) from error


def prove(
    path: Path,
    time_limit: float = TIME_LIMIT,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> Proof:
    """Render the saved file `path` with and without the extension, wait, and compare.

    `tell` gets each new state; the rest is as ProofRun() has it. Raises ProofError.
    """
    with ProofRun(path, time_limit) as run:
        return wait_for(run, tell)
