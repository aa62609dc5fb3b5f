# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds every .blend file of this folder: `make scenes`."""

from addon.core.kinds import KINDS

from . import build_showcase, fixtures
from .leave import leave


def main() -> None:
    """Build the files one after the other."""
    for kind in KINDS:
        fixtures.build_sphere_sun(kind)
        fixtures.build_furnace(kind)
    fixtures.build_slab("DIELECTRIC")
    build_showcase.build()


if __name__ == "__main__":
    main()
    leave()
