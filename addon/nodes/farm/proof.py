# SPDX-License-Identifier: GPL-3.0-or-later
"""Proves by rendering that a file needs no extension.

Two Blenders of their own render the file small: one with the extension, which compiles the shaders
anew, and one with the file alone. The pictures have to be the same.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.finding import Finding

# Of the picture's light. The same shader gives the same bits, but where Blender 4.5 sums smooth
# normals in an order that changes from run to run: a last bit of these moves some random walks.
TOLERANCE = 0.02
TIME_LIMIT = 300.0  # seconds, of each render


class ProofError(RuntimeError):
    """The file could not be rendered; the message says in which Blender and why."""


@dataclass(frozen=True)
class Proof:
    """What the comparison gave.

    difference -- mean distance of the pixels, over the mean of the picture with the extension
    brightness -- that mean, over RGB
    seconds    -- what both renders took together, with the start of their Blenders
    """

    difference: float
    brightness: float
    seconds: float

    @property
    def ok(self) -> bool:
        """Whether the pictures are the same, and show something."""
        return self.brightness > 0.0 and self.difference <= TOLERANCE

    def findings(self, path: Path) -> list[Finding]:
        """Return what is wrong with the file `path`, nothing where the pictures are the same."""
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
        return [Finding("error", subject, message, "Mend the other findings, and save again.")]


def prove(
    path: Path, time_limit: float = TIME_LIMIT, tell: Callable[[str], None] = lambda text: None
) -> Proof:
    """Render the saved file `path` with and without the extension, and compare.

    The open file is left alone. `tell` gets a line before each render, which may take `time_limit`
    seconds. Raises ProofError where one does not come about.
    """
    import numpy

    extension = str(Path(__file__).resolve().parents[2])
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="microbounce_") as folder:
        tell("Rendering with the extension, its shaders compiled anew (1 of 2)")
        ours = _rendered(path, Path(folder, "with"), extension, time_limit)
        tell("Rendering without the extension (2 of 2)")
        alone = _rendered(path, Path(folder, "without"), "", time_limit)
        ours, alone = (numpy.fromfile(file, dtype=numpy.float32) for file in (ours, alone))
    ours, alone = (values.reshape(-1, 4)[:, :3].astype(numpy.float64) for values in (ours, alone))
    brightness = float(ours.mean())
    distance = float(numpy.abs(ours - alone).mean())
    difference = distance / brightness if brightness > 0.0 else distance
    return Proof(difference, brightness, time.monotonic() - start)


def _rendered(path: Path, target: Path, extension: str, time_limit: float) -> Path:
    script = str(Path(__file__).with_name("child.py"))
    if bpy.app.binary_path:
        command = [bpy.app.binary_path, "--background", "--factory-startup", "--python", script]
    else:  # Blender as a Python module; -P keeps this folder from hiding Python's own modules
        command = [sys.executable, "-P", script]
    who = "with the extension" if extension else "without the extension"
    resources = target.with_name(f"{target.name}_user")
    resources.mkdir()
    try:
        done = subprocess.run(
            [*command, "--", str(path), str(target), extension],
            env=_environment(resources),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=time_limit,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise ProofError(
            f"The render {who} took longer than {time_limit:g} seconds: allow more, or hide "
            "what is heavy"
        ) from error
    except OSError as error:
        raise ProofError(f"The Blender {who} does not start: {error}") from error
    if done.returncode != 0 or not target.is_file():
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        reason = lines[-1].strip() if lines else f"it left with exit code {done.returncode}"
        raise ProofError(f"The render {who} failed: {reason}")
    return target


def _environment(resources: Path) -> dict[str, str]:
    """Return this process's variables, but with an empty folder for all of Blender's user files.

    So there are neither preferences nor installed extensions.
    """
    kept = {name: text for name, text in os.environ.items() if not name.startswith("BLENDER_USER_")}
    return kept | {"BLENDER_USER_RESOURCES": str(resources)}
