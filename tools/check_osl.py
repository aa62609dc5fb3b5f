# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the form of the OSL sources: licence line, include guards, line length, file length."""

import re
import sys
from pathlib import Path

LICENCE = "// SPDX-License-Identifier: GPL-3.0-or-later"
LONGEST_LINE = 100
# One concept a file; a longer one wants to be two. Tables are as long as they are.
LONGEST_FILE = 300


def complaints(path: Path) -> list[str]:
    """Return what is wrong with one source, a line of text each; empty if nothing is."""
    lines = path.read_text(encoding="utf-8").splitlines()
    found = []
    if not lines or lines[0] != LICENCE:
        found.append(f"{path}:1: the first line must be '{LICENCE}'")
    for number, line in enumerate(lines, start=1):
        if len(line) > LONGEST_LINE:
            found.append(f"{path}:{number}: {len(line)} characters; at most {LONGEST_LINE}")
        if "\t" in line or line != line.rstrip():
            found.append(f"{path}:{number}: a tab, or a blank at the end")
    if len(lines) > LONGEST_FILE and path.parent.name != "tables":
        found.append(f"{path}: {len(lines)} lines; at most {LONGEST_FILE}")
    if path.suffix == ".h":
        directives = [line for line in lines if line.lstrip().startswith("#")]
        guard = re.fullmatch(r"#ifndef (\w+)", directives[0]) if directives else None
        if (
            guard is None
            or directives[1:2] != [f"#define {guard.group(1)}"]
            or not directives[-1].startswith("#endif")
        ):
            found.append(f"{path}: no include guard (#ifndef X, #define X ... #endif)")
    return found


def main() -> int:
    """Check every source under osl/ and print what is wrong; return the exit code."""
    root = Path(__file__).resolve().parent.parent
    sources = sorted([*root.glob("osl/**/*.osl"), *root.glob("osl/**/*.h")])
    if not sources:
        print("tools/check_osl.py: no OSL source found under osl/", file=sys.stderr)
        return 1
    found = [line for path in sources for line in complaints(path.relative_to(root))]
    print("\n".join(found) if found else f"{len(sources)} OSL sources checked")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
