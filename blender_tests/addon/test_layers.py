# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrows between the extension's rooms point one way."""

import ast
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "addon"
ROOMS = ("core", "material", "convert", "scene", "analysis", "cost", "farm", "presets")
# What each folder may import of the others.
ALLOWED = {
    "core": set(),
    "material": {"core"},
    "convert": {"core", "material"},
    "scene": {"core", "material"},
    "analysis": {"core", "material", "scene"},
    "cost": {"core", "material", "scene"},
    "farm": {"core", "material", "scene"},
    "presets": {"core", "material"},
    "operators": set(ROOMS),
    "ui": {*ROOMS, "operators"},
    "command": set(ROOMS),
}


def imported(path: Path) -> set[str]:
    """Return the folders of the extension, and the foreign packages, that a file imports."""
    package = ["addon", *path.relative_to(ADDON).parts[:-1]]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            if not node.level:
                found.add(node.module.partition(".")[0])
                continue
            base = package[: len(package) - node.level + 1]
            target = [*base, *(node.module or "").split(".")]
            names = [target[1:]] if node.module else [[*base[1:], a.name] for a in node.names]
            found |= {name[0] for name in names if (ADDON / name[0]).is_dir()}
    return found


FILES = [path for path in sorted(ADDON.rglob("*.py")) if path.parent != ADDON]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(ADDON).as_posix())
def test_no_room_imports_one_it_must_not_know(path: Path) -> None:
    room = path.relative_to(ADDON).parts[0]
    folders = {name for name in imported(path) if (ADDON / name).is_dir()}
    assert folders <= ALLOWED[room] | {room}


@pytest.mark.parametrize("path", sorted((ADDON / "core").rglob("*.py")), ids=lambda p: p.stem)
def test_the_core_knows_nothing_of_blender(path: Path) -> None:
    assert not {"bpy", "mathutils", "_cycles"} & imported(path)
