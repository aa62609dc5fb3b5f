# SPDX-License-Identifier: GPL-3.0-or-later
"""Generated tables: up to date, and as accurate as they say."""

import subprocess
import sys
from pathlib import Path

import numpy as np

from blender_tests.oracle.error_function import deficit

from .probe import evaluate

GENERATOR = Path(__file__).resolve().parents[2] / "osl" / "tables" / "ierfcx.py"


def test_header_is_what_the_generator_writes() -> None:
    done = subprocess.run(
        [sys.executable, str(GENERATOR), "--check"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_ierfcx() -> None:
    x = np.concatenate([[0.0], np.geomspace(1e-6, 1e4, 4000)]).astype(np.float32)
    found = evaluate("../tables/ierfcx.h", "result = ierfcx(x);", x=x)[:, 0]
    wanted = deficit(x.astype(float))
    assert np.max(np.abs(found / wanted - 1.0)) < 1e-6
