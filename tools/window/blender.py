# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds a Blender and a display, and runs a script in that Blender's window."""

import json
import os
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

SIZE = (1600, 1000)  # of the window and of the screen, in pixels
_START_OF_XVFB = 10.0  # seconds


class NoWindowError(RuntimeError):
    """This machine cannot open a Blender with a window. The message says what is missing."""


def find_blender() -> list[str]:
    """Return the command that starts Blender, from the variable BLENDER or from PATH.

    Raises NoWindowError if there is none.
    """
    command = shlex.split(os.environ.get("BLENDER", "")) or ["blender"]
    found = shutil.which(command[0])
    if found is None:
        reason = (
            f"BLENDER names {command[0]}, which is no command" if command != ["blender"] else ""
        )
        raise NoWindowError(reason or "no Blender: set BLENDER to the command that starts it")
    return [found, *command[1:]]


def need_display() -> None:
    """Raise NoWindowError if there is neither a display nor Xvfb to make one."""
    if sys.platform == "linux" and not _has_display() and not _has_xvfb():
        raise NoWindowError("no display: install Xvfb, or set DISPLAY")


def run_in_window(script: Path, settings: dict[str, object], seconds: float) -> dict[str, object]:
    """Run `script` in the window of a Blender with factory settings; return its result.

    The script's first argument is a JSON file with `settings`. Their key "screen" names the file
    that holds Xvfb's screen, "" without Xvfb. The script writes its result as JSON to the second
    argument. User files go to a folder that is deleted afterwards. The result's key "printed" has
    what Blender wrote to the console. Raises NoWindowError if no window can be
    opened, TimeoutError after `seconds`, RuntimeError if the script left no result.
    """
    blender = find_blender()
    need_display()
    with TemporaryDirectory(prefix="microbounce_window_") as name, _display(name) as display:
        folder = Path(name)
        screen = folder / "Xvfb_screen0"
        settings = settings | {"screen": str(screen) if screen.is_file() else ""}
        (folder / "settings.json").write_text(json.dumps(settings), encoding="utf-8")
        result = folder / "result.json"
        width, height = map(str, SIZE)
        done = _run(
            [
                *blender,
                "--factory-startup",
                "--enable-event-simulate",
                *("--window-geometry", "0", "0", width, height),
                *("--python-exit-code", "3", "--python", str(script)),
                *("--", str(folder / "settings.json"), str(result)),
            ],
            display | {"BLENDER_USER_RESOURCES": str(folder / "user"), "TMPDIR": str(folder)},
            folder / "printed.txt",
            seconds,
        )
        if not result.is_file():
            raise RuntimeError(f"Blender left no result (exit code {done[0]}):\n{done[1][-4000:]}")
        return json.loads(result.read_text(encoding="utf-8")) | {"printed": done[1]}


def _run(
    command: list[str], environment: dict[str, str], log: Path, seconds: float
) -> tuple[int, str]:
    """Return exit code and output. At a timeout the whole group of processes ends."""
    with log.open("w", encoding="utf-8") as sink:
        process = subprocess.Popen(
            command,
            env=os.environ | environment,
            stdout=sink,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            code = process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            _end(process)
            printed = log.read_text(encoding="utf-8", errors="replace")
            message = f"Blender was still running after {seconds:.0f} s:\n{printed[-4000:]}"
            raise TimeoutError(message) from None
    return code, log.read_text(encoding="utf-8", errors="replace")


def _end(process: subprocess.Popen) -> None:
    """End a process in its own session, with its children."""
    if hasattr(os, "killpg"):
        os.killpg(process.pid, 9)
    else:
        process.kill()
    process.wait()


def _has_display() -> bool:
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _has_xvfb() -> bool:
    return sys.platform == "linux" and shutil.which("Xvfb") is not None


@contextmanager
def _display(folder: str) -> Iterator[dict[str, str]]:
    """Yield the variables that name a display: Xvfb with its screen in `folder`, or the user's."""
    if not _has_xvfb():
        yield {}
        return
    # Xvfb picks a free number and writes it into the pipe.
    reading, writing = os.pipe()
    screen = ["-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-fbdir", folder]
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), *screen],
        pass_fds=[writing],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    os.close(writing)
    try:
        yield {"DISPLAY": f":{_number(reading, server)}", "LIBGL_ALWAYS_SOFTWARE": "1"}
    finally:
        os.close(reading)
        _end(server)


def _number(reading: int, server: subprocess.Popen) -> int:
    os.set_blocking(reading, False)
    end = time.monotonic() + _START_OF_XVFB
    text = b""
    while not text.endswith(b"\n"):
        if server.poll() is not None or time.monotonic() > end:
            raise NoWindowError("Xvfb does not start: try it by hand, or set DISPLAY")
        try:
            text += os.read(reading, 16)
        except BlockingIOError:
            time.sleep(0.05)
    return int(text)
