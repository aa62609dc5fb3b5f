# SPDX-License-Identifier: GPL-3.0-or-later
"""One session in Blender's window with the zip that the repository makes."""

import subprocess
import sys
from pathlib import Path

from .blender import SIZE, run_in_window

# Editors, by Blender's names of their types.
NODES, PROPERTIES, VIEW = "ShaderNodeTree", "PROPERTIES", "VIEW_3D"

ROOT = Path(__file__).resolve().parents[2]
_SCREENS = ROOT / "build" / "window"

# Seconds. A session takes about a minute without a graphics card.
_BUILD, _SESSION = 300.0, 300.0


def run_session(folder: Path) -> dict[str, object]:
    """Build the zip, use it in a window, and return what `inside.py` wrote down.

    Screens come to lie in `folder` and, as PNGs, in build/window. Raises what run_in_window()
    raises, and
    subprocess.CalledProcessError where the zip cannot be built.
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
    """Save the screens where somebody can look at them."""
    from .screen import save_part

    _SCREENS.mkdir(parents=True, exist_ok=True)
    for screen in folder.glob("*.xwd"):
        save_part(screen, [0, 0, *SIZE], _SCREENS / f"{screen.stem}.png")
