# SPDX-License-Identifier: GPL-3.0-or-later
"""Another Blender that runs a module of ours, beside the one that is open."""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy

# Time to end by itself; it may be at work where it does not notice that it should.
_END_SECONDS = 0.5


class ChildBlender:
    """The process; close() it whatever happens, or use it with `with`.

    It ends when its standard input closes, also if the Blender that started it crashes.
    """

    def __init__(self, module: str, arguments: Sequence[str], folder: Path) -> None:
        """Start it and call run(*arguments) of a module of the extension, such as "cost.measure".

        `folder` must not exist yet. It takes what the process prints, and stands for the user's
        files: there are neither preferences nor installed extensions. Raises OSError if the
        process or the folder cannot be made.
        """
        script = str(Path(__file__).with_name("child_start.py"))
        if bpy.app.binary_path:
            command = [bpy.app.binary_path, "--background", "--factory-startup", "--python"]
        else:  # Blender as a Python module; -P keeps the script's folder from hiding Python's own
            command = [sys.executable, "-P"]
        folder.mkdir()
        self._errors = folder / "errors"
        with open(folder / "log", "wb") as log, open(self._errors, "wb") as errors:
            self._process = subprocess.Popen(
                [*command, script, "--", module, *arguments],
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
        """Return why it failed, its last line of errors, once it does not run; "" if all went
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
