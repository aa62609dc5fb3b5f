# SPDX-License-Identifier: GPL-3.0-or-later
"""A child that fails starts again. A child that hangs is ended."""

import subprocess
import sys
import time

import pytest

from tools.bench import runner
from tools.bench.plan import PLANS

SCENES = PLANS["quick"][:2]
STEP = "import sys; print('STEP 5', file=sys.stderr, flush=True)"


def run(tmp_path, script: str, **options) -> list[str]:
    def command(plan, scene, folder, log, repeat):
        assert plan == "quick"
        return [sys.executable, "-c", script, scene, str(folder), str(repeat)]

    return runner.run_scenes("quick", SCENES, tmp_path, tmp_path / "log", False, command=command,
                             **options)  # fmt: skip


def test_all_scenes_run_and_are_told_how_often(tmp_path):
    note = "; from pathlib import Path; Path(sys.argv[2], sys.argv[1]).write_text(sys.argv[3])"
    assert run(tmp_path, STEP + note, repeat=3) == []
    assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {s.name: "3" for s in SCENES}


def test_a_child_that_fails_once_is_started_again(tmp_path):
    script = (
        f"{STEP}; from pathlib import Path; mark = Path(sys.argv[2], sys.argv[1]); "
        "known = mark.exists(); mark.touch(); sys.exit(0 if known else 11)"
    )
    assert run(tmp_path, script) == []


def test_a_child_that_fails_is_told_and_the_next_scene_still_runs(tmp_path):
    script = (
        f"{STEP}; from pathlib import Path; Path(sys.argv[2], sys.argv[1]).touch(); "
        f"sys.exit('no light' if sys.argv[1] == {SCENES[0].name!r} else 0)"
    )
    (failure,) = run(tmp_path, script)
    assert failure == f"{SCENES[0].name}: exit code 1\nno light"
    assert (tmp_path / SCENES[1].name).exists()


def test_a_silent_child_is_ended(tmp_path):
    start = time.perf_counter()
    failures = run(tmp_path, f"{STEP}; import time; time.sleep(60)", silence=0.4)
    assert time.perf_counter() - start < 20
    assert len(failures) == 2
    assert all("it printed nothing for 0.4 s and was ended" in failure for failure in failures)


@pytest.mark.parametrize("arguments", [("quick", "atlantis"), ("no plan", "showcase")])
def test_an_unknown_scene_or_plan_is_told(arguments, tmp_path):
    plan, scene = arguments
    command = runner.child_command(plan, scene, tmp_path, tmp_path / "log", 1)
    done = subprocess.run(command, cwd=runner.ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert "invalid choice" in done.stderr or "atlantis" in done.stderr
