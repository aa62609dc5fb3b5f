# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries the extension in a real Blender's window: `test` runs the tests, `pictures` renews docs/.

If no such Blender can be opened, it says why and ends with exit code 0.
"""

import argparse
import os
import shlex
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from scenes.leave import leave

from .blender import NoWindowError, find_blender, need_display
from .session import NODES, PROPERTIES, ROOT, run_session

# The pictures in docs/: the moment of the session, and the editor.
_PICTURES = {
    "presets.jpg": ("pictures", PROPERTIES),
    "shader_editor.jpg": ("checked", NODES),
}


def main() -> int:
    """Do what the command line says; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.window", description=__doc__.splitlines()[0]
    )
    parser.add_argument("task", choices=("test", "pictures"))
    task = parser.parse_args().task
    try:
        blender = find_blender()
        need_display()
    except NoWindowError as reason:
        print(f"skipped: {reason}")
        return 0
    return _test(blender) if task == "test" else _pictures()


def _test(blender: list[str]) -> int:
    command = [sys.executable, "-m", "pytest", "blender_tests/window"]
    environment = os.environ | {"BLENDER": shlex.join(blender)}
    return subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode


def _pictures() -> int:
    from .screen import save_part

    with TemporaryDirectory(prefix="microbounce_window_") as name:
        folder = Path(name)
        result = run_session(folder)
        if result["errors"] or not (folder / "searched.xwd").is_file():
            reasons = result["errors"] or ["pictures need Xvfb: install it"]
            print("No picture was taken:", *reasons, file=sys.stderr)
            return 1
        for name, (moment, editor) in _PICTURES.items():
            target = ROOT / "docs" / name
            save_part(folder / f"{moment}.xwd", result["areas"][moment][editor], target)
            print(f"{target.relative_to(ROOT)}: {target.stat().st_size / 1024:.0f} KiB")
    return 0


if __name__ == "__main__":
    leave(main())
