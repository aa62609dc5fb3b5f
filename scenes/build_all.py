# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds every .blend file of this folder."""

import os
import sys

from . import build_furnace_conductor, build_showcase, build_sphere_sun_conductor


def main() -> None:
    """Build them one after the other."""
    build_sphere_sun_conductor.build()
    build_furnace_conductor.build()
    build_showcase.build()


if __name__ == "__main__":
    main()
    # bpy 4.5 was seen to hang while it takes itself down.
    sys.stdout.flush()
    os._exit(0)
