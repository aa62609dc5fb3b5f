# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension's layers: what each folder may import of the others, and none of it upwards."""

import ast
from pathlib import Path

import pytest

ADDON = Path(__file__).resolve().parents[2] / "addon"
# From the lowest: a folder imports those before it, and itself.
LAYERS = ("core", "nodes", "ops", "ui")
# The command line stands beside the interface: it uses what operators use, and none of them.
COMMAND = {"core", "nodes", "command"}


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
def test_nothing_is_imported_from_above(path: Path) -> None:
    layer = path.relative_to(ADDON).parts[0]
    folders = {name for name in imported(path) if (ADDON / name).is_dir()}
    allowed = COMMAND if layer == "command" else set(LAYERS[: LAYERS.index(layer) + 1])
    assert folders <= allowed


@pytest.mark.parametrize("path", sorted((ADDON / "core").rglob("*.py")), ids=lambda p: p.stem)
def test_the_core_knows_nothing_of_blender(path: Path) -> None:
    assert not {"bpy", "mathutils", "_cycles"} & imported(path)
