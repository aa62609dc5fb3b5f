# SPDX-License-Identifier: GPL-3.0-or-later
"""Catches the output of Blender's compiled parts, the OSL compiler's only way to report."""

import os
import sys
import tempfile
from collections.abc import Callable


def captured_output(call: Callable[[], object]) -> tuple[object, str]:
    """Run `call` and return its result with the text it wrote to standard output and error.

    The text is empty if the process has no such streams (a windowed start on Windows).
    """
    _flush()
    with tempfile.TemporaryFile() as sink:
        saved = []
        try:
            for descriptor in (1, 2):
                try:
                    saved.append((descriptor, os.dup(descriptor)))
                except OSError:  # the stream is closed: nothing to catch from it
                    continue
                os.dup2(sink.fileno(), descriptor)
            result = call()
        finally:
            _flush()
            for descriptor, copy in saved:
                os.dup2(copy, descriptor)
                os.close(copy)
        sink.seek(0)
        return result, sink.read().decode("utf-8", "replace")


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
