# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks a copy of the project in one place at a time and runs the tests that should notice.

    python -m blender_tests.mutants [WORD ...] [--write]

A word picks the mutants with it in their name. Each mutant runs the tests named beside it, then
the whole fast tier if those pass. `--write` renews the table in blender_tests/README.md.

Exit status: 0 if every mutant is caught, 1 if one survives, 2 if the list or the use is wrong.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

from .catalogue import MUTANTS, Mutant

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "blender_tests/README.md"
MARKS = ("<!-- mutants: made by `make test-mutants MUTANTS=--write` -->\n", "<!-- end -->\n")
# These compare stamps of sources. They would notice any edit, so they prove nothing.
STAMPS = (
    "blender_tests/scenes/test_blend_files.py",
    "blender_tests/tools/previews",
    "blender_tests/tools/figures/test_committed.py",
    "blender_tests/test_mutants.py",
)
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)


@dataclass(frozen=True)
class Verdict:
    """How a mutant fared: the test that failed ("" if none did) and the seconds it took."""

    mutant: Mutant
    caught_by: str
    seconds: float


def copy_project(target: Path) -> None:
    """Copy what git tracks or would track."""
    listing = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    names = subprocess.run(listing, cwd=ROOT, capture_output=True, check=True).stdout
    for name in filter(None, names.decode().split("\0")):
        if (ROOT / name).is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, target / name)


def first_failure(folder: Path, arguments: list[str]) -> str:
    """Return the name of the first test that fails, or "" if all pass."""
    # Bytecode is found by the time and size of its source; a mutant can have both the same.
    environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *arguments]
    found = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    if found.returncode == 0:
        return ""
    failed = FAILED.search(found.stdout)
    if failed is None:
        raise RuntimeError(f"pytest {' '.join(arguments)} gave no result:\n{found.stdout[-3000:]}")
    return failed[1]


def try_mutant(mutant: Mutant, folder: Path) -> Verdict:
    """Break the copy in `folder`, run the tests, mend it."""
    start = time.monotonic()
    path = folder / mutant.path
    text = path.read_text("utf-8")
    path.write_text(mutant.apply(text), "utf-8")
    try:
        caught_by = first_failure(folder, list(mutant.tests))
        if not caught_by:
            ignored = [f"--ignore={stamp}" for stamp in STAMPS]
            caught_by = first_failure(folder, ["blender_tests", *ignored])
    finally:
        path.write_text(text, "utf-8")
    return Verdict(mutant, caught_by, time.monotonic() - start)


def table(verdicts: list[Verdict]) -> str:
    """Return the verdicts as a Markdown table."""
    rows = ["| what is broken | where | the test that fails |", "| --- | --- | --- |"]
    for verdict in verdicts:
        file, _, test = verdict.caught_by.removeprefix("blender_tests/").partition("::")
        rows.append(f"| {verdict.mutant.name} | `{verdict.mutant.path}` | `{file}` `{test}` |")
    return "\n".join(rows) + "\n"


def main() -> int:
    """Try the mutants that were asked for."""
    parser = argparse.ArgumentParser(prog="make test-mutants", description=__doc__.split("\n")[0])
    parser.add_argument("word", nargs="*", help="only mutants with one of these in their name")
    parser.add_argument("--write", action="store_true", help="renew the table in the README")
    arguments = parser.parse_args()
    words = arguments.word
    chosen = [m for m in MUTANTS if not words or any(word in m.name for word in words)]
    if not chosen or (arguments.write and words):
        parser.error("no mutant has these words" if not chosen else "--write wants all mutants")

    workers = min(4, os.cpu_count() or 1)
    with tempfile.TemporaryDirectory(prefix="microbounce_mutants_") as temporary:
        free: SimpleQueue[Path] = SimpleQueue()
        for number in range(workers):
            copy_project(Path(temporary, str(number)))
            free.put(Path(temporary, str(number)))
        print("The tests pass without a mutant ...", flush=True)
        tests = sorted({test for mutant in chosen for test in mutant.tests})
        failure = first_failure(Path(temporary, "0"), ["-n", str(workers), *tests])
        if failure:
            print(f"{failure} fails without a mutant.", file=sys.stderr)
            return 2

        def run(mutant: Mutant) -> Verdict:
            folder = free.get()
            try:
                verdict = try_mutant(mutant, folder)
            finally:
                free.put(folder)
            outcome = f"caught by {verdict.caught_by}" if verdict.caught_by else "SURVIVES"
            print(f"{mutant.name}: {outcome} ({verdict.seconds:.0f} s)", flush=True)
            return verdict

        with ThreadPoolExecutor(workers) as pool:
            verdicts = list(pool.map(run, chosen))

    survivors = [verdict for verdict in verdicts if not verdict.caught_by]
    print(f"{len(verdicts) - len(survivors)} of {len(verdicts)} mutants caught.")
    if arguments.write and not survivors:
        text = README.read_text("utf-8")
        before, rest = text.split(MARKS[0])
        after = rest.split(MARKS[1])[1]
        README.write_text(before + MARKS[0] + table(verdicts) + MARKS[1] + after, "utf-8")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
