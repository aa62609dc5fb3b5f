# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps each round of a variant on disk, so an interrupted benchmark can go on.

The file's name has a digest of all that the result depends on: the scene, the variant and its
samples, the shaders, the code that renders, the .blend file, the reference, Blender's version and
the CPU.
"""

import hashlib
import io
import zipfile
import zlib
from functools import cache
from importlib.metadata import version
from pathlib import Path

import numpy as np

from tools.figures.cache import ROOT, sources, write

from .machine import cpu_model
from .plan import Scene, Variant

Result = dict[str, np.ndarray]

_REFERENCES = ROOT / "blender_tests" / "references"
_BLEND = {
    "slab": "slab_{}",
    "sun": "sphere_sun_{}",
    "back": "sphere_sun_{}",
    "furnace": "furnace_{}",
    "showcase": "showcase",
}


def run_path(folder: Path, scene: Scene, variant: Variant, turn: int) -> Path:
    """The file of the result of round `turn` of a variant."""
    what = f"{variant!r} {scene.tops[turn]} {turn}"
    return folder / f"{scene.name}-{_digest(scene, what)}.npz"


def reference_path(folder: Path, scene: Scene) -> Path:
    """The file of the reference, its mask and the machine's description."""
    return folder / f"{scene.name}-reference-{_digest(scene, 'reference')}.npz"


def save(path: Path, result: Result) -> None:
    """Write a result, whole or not at all."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **result)
    path.parent.mkdir(parents=True, exist_ok=True)
    write(path, buffer.getvalue())


def load(path: Path) -> Result | None:
    """Read a result; None if it is missing or damaged."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error):
        return None


def _digest(scene: Scene, what: str) -> str:
    shown = f"{scene.stage} {scene.kind} {scene.values!r} {scene.percentage}"
    reference = f"{scene.reference} {scene.others!r} {scene.reference_samples}"
    made_from = f"{what} {shown} {reference} {_source_digest()} {_scene_digest(scene)}"
    return hashlib.sha256(made_from.encode()).hexdigest()[:20]


@cache
def _scene_digest(scene: Scene) -> str:
    files = [
        _REFERENCES / f"{name}.exr" for name in (scene.reference, *dict(scene.others).values())
    ]
    if scene.stage in _BLEND:
        files.append(ROOT / "scenes" / f"{_BLEND[scene.stage].format(scene.kind.lower())}.blend")
    return _of_files([file for file in files if file.is_file()])


@cache
def _source_digest() -> str:
    """A digest of the shaders and of the code that renders, without what draws and writes."""
    code = {
        file
        for module in ("stage", "measure")
        for file in sources(Path(__file__).with_name(f"{module}.py"))
    }
    # Each result's own digest has the part of the plan that it depends on.
    code.discard(Path(__file__).with_name("plan.py"))
    shaders = [*(ROOT / "osl").rglob("*.osl"), *(ROOT / "osl").rglob("*.h")]
    return f"{_of_files([*code, *shaders])} {version('bpy')} {cpu_model()}"


def _of_files(files: list[Path]) -> str:
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.name.encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()
