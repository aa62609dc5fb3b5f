# SPDX-License-Identifier: GPL-3.0-or-later
"""Many calls of one function on all cores, with progress."""

import multiprocessing
import os
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from tqdm import tqdm

# run(function, arguments, what): the results of function(*one) for each of the arguments.
Run = Callable[[Callable[..., Any], Sequence[tuple], str], list]


def run(function: Callable[..., Any], arguments: Sequence[tuple], what: str) -> list:
    """Call ``function`` on every tuple of ``arguments``; results in their order."""
    # More threads in each process would only stand in each other's way.
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with multiprocessing.get_context("spawn").Pool() as pool:
        found = pool.imap(partial(_call, function), arguments)
        bar = tqdm(found, desc=what, total=len(arguments), file=sys.stderr)
        return list(bar)


def _call(function: Callable[..., Any], arguments: tuple) -> Any:
    return function(*arguments)
