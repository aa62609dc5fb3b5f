# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit the shaders' tables again: `python -m osl.tables`, or `make tables`.

python -m osl.tables                     writes every header (see --help for one alone)
python -m osl.tables --check             fails if a header is older than what made it
"""

import argparse
import sys
from pathlib import Path

from . import anisotropic, conductor, dielectric, diffuse, header, special
from .run import run

FOLDER = Path(__file__).resolve().parent
ORACLE = FOLDER.parent / "oracle"
SHARED = ("closures.py", "fitting.py", "grid.py", "header.py")
# The parts of the oracle that decide on the values.
MODEL = ("estimate.py", "masking.py", "materials.py", "ndf.py", "visible.py", "walk.py")

FITTED = {
    "anisotropic": anisotropic,
    "conductor": conductor,
    "dielectric": dielectric,
    "diffuse": diffuse,
}


def stamp(name: str) -> str:
    """The stamp of a header's sources as they are now."""
    own = (f"{name}.py", *getattr(FITTED[name], "SOURCES", ()))
    return header.stamp([*(FOLDER / s for s in own + SHARED), *(ORACLE / s for s in MODEL)])


def path(name: str) -> Path:
    """The header of one material."""
    return FOLDER / f"{name}_lobes.h"


def write(name: str) -> None:
    """Fit one material's tables and write its header."""
    about, body = FITTED[name].body(run)
    text = header.HEADER.format(
        generator=f"{name}.py",
        guard=f"{name}_LOBES".upper(),
        lines="\n// ".join(about),
        stamp=stamp(name),
        digest=header.digest(body),
        body=body,
    )
    path(name).write_text(text, encoding="utf-8")


def is_stale(name: str) -> bool:
    """Whether a header is missing, older than its sources, or edited by hand."""
    if not path(name).is_file():
        return True
    text = path(name).read_text("utf-8")
    _, _, rest = text.partition('#include "../include/table.h"\n\n')
    body = rest.removesuffix("\n#endif\n")
    return f"// Sources {stamp(name)}, body {header.digest(body)}.\n" not in text


def main() -> int:
    """Write or check the headers; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m osl.tables", description=__doc__.split(":")[0])
    parser.add_argument("names", nargs="*", help=f"of {', '.join(FITTED)}; default: all")
    parser.add_argument("--check", action="store_true", help="fail if a header is out of date")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(FITTED)
    if unknown:
        parser.error(f"no table is called {', '.join(sorted(unknown))}: use {', '.join(FITTED)}")
    names = arguments.names or list(FITTED)
    if arguments.check:
        stale = [path(name).name for name in names if is_stale(name)]
        stale += [special.HEADER.name] if special.is_stale() else []
        if stale:
            print(f"older than their sources: {', '.join(stale)}. Run make tables")
        return 1 if stale else 0
    special.HEADER.write_text(special.header(), encoding="utf-8")
    for name in names:
        write(name)
        print(f"{path(name).name}: {path(name).stat().st_size / 1024:.0f} KB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
