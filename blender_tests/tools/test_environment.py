# SPDX-License-Identifier: GPL-3.0-or-later
"""The script that makes the virtual environments: its messages and its choice of Python."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[2] / "tools"
NEEDED = ("bash", "cat", "cksum", "dirname", "rm", "tail")


@pytest.fixture
def bare(tmp_path):
    """A function that runs a copy of the script, in a project of its own, without system folders.

    The project's path has a space. PATH has only the commands in `NEEDED` and what a test adds.
    """
    project = tmp_path / "a project"
    (project / "tools").mkdir(parents=True)
    commands = tmp_path / "bin"
    commands.mkdir()
    for name in NEEDED:
        (commands / name).symlink_to(shutil.which(name))
    for version in ("4.5", "5.2"):
        (project / "tools" / f"requirements-{version}.txt").write_text("")
    text = (TOOLS / "environment.sh").read_text()
    for folder in ("/usr/bin/", "/usr/local/bin/", "/opt/homebrew/bin/", "/Library/Frameworks/"):
        text = text.replace(folder, f"/nowhere{folder}")
    script = project / "tools" / "environment.sh"
    script.write_text(text)

    def run(*arguments, **environment):
        """Run the script. A variable that is None is not set."""
        given = {"PATH": str(commands), "HOME": str(tmp_path / "home")} | environment
        return subprocess.run(
            [commands / "bash", "tools/environment.sh", *arguments],
            cwd=project,
            env={name: value for name, value in given.items() if value is not None},
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )

    run.project, run.commands, run.home = project, commands, tmp_path / "home"
    return run


def put_program(path, body):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!{shutil.which('bash')}\n{body}\n")
    path.chmod(0o755)


def this_python():
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def this_blender():
    return {"3.13": "5.2", "3.11": "4.5"}[this_python()]


def test_neither_python_is_an_error_that_names_both(bare):
    result = bare("any")
    assert result.returncode == 2
    assert result.stdout == ""
    for words in ("Python 3.13", "Python 3.11", "Blender 5.2", "Blender 4.5"):
        assert words in result.stderr
    assert "pyenv install" in result.stderr
    assert "uv python install" in result.stderr


def test_missing_python_of_one_version_is_named(bare):
    result = bare("4.5")
    assert result.returncode == 2
    assert "Python 3.11" in result.stderr
    assert "3.13" not in result.stderr


def test_shim_that_fails_does_not_count(bare):
    for version in ("3.13", "3.11"):
        put_program(bare.commands / f"python{version}", "echo 'not installed' >&2; exit 127")
    assert bare("any").returncode == 2


def test_python_of_another_version_does_not_count(bare):
    other = {"3.13": "3.11", "3.11": "3.13"}[this_python()]
    put_program(bare.commands / f"python{other}", f'exec "{sys._base_executable}" "$@"')
    blender = {"3.13": "5.2", "3.11": "4.5"}[other]
    assert bare(blender).returncode == 2


def test_pyenvs_folder_is_found_behind_a_failing_shim(bare):
    version = this_python()
    put_program(bare.commands / f"python{version}", "exit 127")
    real = bare.home / ".pyenv" / "versions" / f"{version}.99" / "bin" / f"python{version}"
    put_program(real, f'exec "{sys._base_executable}" "$@"')
    result = bare(this_blender())
    # The environment is made, but without bpy, because the requirements here are empty.
    assert "Made .venv" in result.stderr
    assert str(real) in result.stderr
    assert "No module named 'bpy'" in result.stderr
    assert result.returncode == 1
    folder = bare.project / f".venv-{this_blender()}"
    assert not (folder / "complete").exists()
    # The second run only tries the import again, because bpy may have come from elsewhere.
    again = bare(this_blender())
    assert again.returncode == 1
    assert "Made .venv" not in again.stderr
    assert "Installing" not in again.stderr


def test_complete_environment_is_used_at_once(bare):
    folder = bare.project / f".venv-{this_blender()}"
    (folder / "bin").mkdir(parents=True)
    (folder / "bin" / "python").symlink_to(sys.executable)
    sums = subprocess.run(["cksum"], input="", capture_output=True, text=True, check=True)
    (folder / "complete").write_text(sums.stdout)
    result = bare(this_blender())
    assert result.returncode == 0
    assert result.stdout.strip() == str(folder / "bin" / "python")
    assert result.stderr == ""


def test_interrupted_environment_is_made_again(bare):
    folder = bare.project / f".venv-{this_blender()}"
    (folder / "bin").mkdir(parents=True)
    (folder / "left over").write_text("")
    put_program(bare.commands / f"python{this_python()}", f'exec "{sys._base_executable}" "$@"')
    result = bare(this_blender())
    assert "Made .venv" in result.stderr
    assert not (folder / "left over").exists()
    assert os.access(folder / "bin" / "python", os.X_OK)


def test_a_machine_without_home_and_with_cdpath(bare):
    put_program(bare.commands / f"python{this_python()}", f'exec "{sys._base_executable}" "$@"')
    result = bare(this_blender(), HOME=None, CDPATH=str(bare.project))
    assert "unbound" not in result.stderr
    assert "Made .venv" in result.stderr
    assert (bare.project / f".venv-{this_blender()}" / "installed").is_file()


def test_settings_of_pip_hold_but_for_user(bare):
    """PIP_USER would make pip refuse a virtual environment. The others say where packages are."""
    requirements = bare.project / "tools" / f"requirements-{this_blender()}.txt"
    requirements.write_text("microbounce-of-nowhere==1\n")
    put_program(bare.commands / f"python{this_python()}", f'exec "{sys._base_executable}" "$@"')
    result = bare(this_blender(), PIP_USER="1", PIP_NO_INDEX="1", PIP_FIND_LINKS=str(bare.commands))
    assert "Can not perform a '--user' install" not in result.stderr
    assert f"Looking in links: {bare.commands}" in result.stderr
    assert "microbounce-of-nowhere" in result.stderr
    assert "The installation failed; the reason stands above" in result.stderr
    assert result.returncode == 1


def test_unknown_version_is_refused(bare):
    result = bare("3.0")
    assert result.returncode == 64
    assert "usage" in result.stderr
