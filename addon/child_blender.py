# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender of its own that runs a script of ours, beside the one that is open."""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy

# That it has to end by itself: it may be at work where it cannot see that it should.
_END_SECONDS = 0.5


class ChildBlender:
    """The process; close() it whatever happens, or use it with `with`.

    Its standard input stays open as long as it is wanted: a script can end when that closes, as it
    does where the Blender that started it crashes.
    """

    def __init__(self, script: Path, arguments: Sequence[str], folder: Path) -> None:
        """Start `script`; what follows "--" in its sys.argv are the `arguments`.

        `folder` must not be there yet. It takes what the process prints, and stands for the user's
        files: there are neither preferences nor installed extensions. Raises OSError where the
        process or the folder cannot be made.
        """
        if bpy.app.binary_path:
            command = [bpy.app.binary_path, "--background", "--factory-startup", "--python"]
        else:  # Blender as a Python module; -P keeps the script's folder from hiding Python's own
            command = [sys.executable, "-P"]
        folder.mkdir()
        self._errors = folder / "errors"
        with open(folder / "log", "wb") as log, open(self._errors, "wb") as errors:
            self._process = subprocess.Popen(
                [*command, str(script), "--", *arguments],
                env=_environment(folder),
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=errors,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )

    def __enter__(self) -> "ChildBlender":
        """Return itself."""
        return self

    def __exit__(self, *error: object) -> None:
        """End it, if it has not ended."""
        self.close()

    @property
    def running(self) -> bool:
        """Whether it is at work."""
        return self._process.poll() is None

    def failure(self) -> str:
        """Return why it failed, its last line of errors, once it does not run; "" where all went
        well."""
        if self._process.returncode == 0:
            return ""
        text = self._errors.read_text("utf-8", errors="replace")
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        return lines[-1] if lines else f"it left with exit code {self._process.returncode}"

    def close(self) -> None:
        """End it, if it runs."""
        self._process.stdin.close()
        try:
            self._process.wait(_END_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def _environment(folder: Path) -> dict[str, str]:
    """Return this process's variables, but with `folder` for all of Blender's user files."""
    kept = {name: text for name, text in os.environ.items() if not name.startswith("BLENDER_USER_")}
    return kept | {"BLENDER_USER_RESOURCES": str(folder)}
