# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one session in Blender's window with the repository's zip."""

import subprocess
import sys
from pathlib import Path

from .blender import SIZE, run_in_window

# Types of editors, as Blender names them.
NODES, PROPERTIES, VIEW = "ShaderNodeTree", "PROPERTIES", "VIEW_3D"

ROOT = Path(__file__).resolve().parents[2]
_SCREENS = ROOT / "build" / "window"

# Seconds. A session takes about a minute without a graphics card.
_BUILD, _SESSION = 300.0, 300.0


def run_session(folder: Path) -> dict[str, object]:
    """Build the zip, use it in a window, and return the result of `inside.py`.

    Screens go to `folder` and, as PNGs, to build/window. Raises as run_in_window(), and
    subprocess.CalledProcessError if the zip cannot be built.
    """
    builder = [sys.executable, "-m", "tools.release.extension"]
    places = ["--output", str(folder / "dist"), "--work", str(folder / "build")]
    subprocess.run(
        [*builder, *places], cwd=ROOT, check=True, timeout=_BUILD, stdout=subprocess.DEVNULL
    )
    (archive,) = (folder / "dist").glob("*.zip")
    settings = {"archive": str(archive), "folder": str(folder), "seconds": 0.9 * _SESSION}
    result = run_in_window(Path(__file__).with_name("inside.py"), settings, _SESSION)
    _show_screens(folder)
    return result


def _show_screens(folder: Path) -> None:
    """Save the screens as PNGs in build/window."""
    from .screen import save_part

    _SCREENS.mkdir(parents=True, exist_ok=True)
    for screen in folder.glob("*.xwd"):
        save_part(screen, [0, 0, *SIZE], _SCREENS / f"{screen.stem}.png")
