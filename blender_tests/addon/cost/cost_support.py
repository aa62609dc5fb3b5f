# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the measured cost share: made-up measurements, a tiny scene, a full dump."""

from pathlib import Path

import bpy
import numpy as np

from addon.core.cost.page import Drawer, Pictures
from addon.core.cost.results import Cost, CostReport, Measured, Setting
from addon.core.cost.statistics import ErrorSplit
from blender_tests.addon.support import small_scene

# What a scene is made of, and how deep the sockets of a material's nodes lie in it.
_KINDS = ("cameras", "collections", "images", "libraries", "lights", "materials", "node_groups",
          "objects", "scenes", "worlds")  # fmt: skip
_DEPTH = 3


def measured(
    key: str,
    seconds: float = 1.0,
    bias: float = 0.0,
    noise: float = 0.1,
    se: float = 1e-5,
    family: str = "step",
    memory: float | None = 11.0,
) -> Measured:
    """Return a made-up measurement of 16 samples that take `seconds`."""
    times = (seconds / 16,) * 3
    cost = Cost(times, times, (0.5,) * 3, memory)
    split = ErrorSplit(bias**2, se, noise)
    return Measured(key, key.title(), family, 16, cost, split)


def report(*variants: Measured, error: float = 0.02, **changes: object) -> CostReport:
    """Return a report of made-up measurements."""
    setting = {
        "file": "a<b.blend",
        "scene": "Scene",
        "frame": 3,
        "width": 24,
        "height": 16,
        "samples": 16,
        "rounds": 3,
        "error": error,
        "reference": "Walk",
        "reference_samples": 256,
        "reference_noise": 0.01,
        "reference_kept": False,
        "date": "2026-01-01T00:00:00+00:00",
        "hardware": {"Processor": "A & B", "Threads": "2"},
        "memory_source": "Cycles",
        "notes": ("A note.",),
    } | changes
    return CostReport(Setting(**setting), variants, "A sentence.", {"page": "cost.html"})


def noisy_pictures(variants: tuple[Measured, ...], widest: int = 24) -> Drawer:
    """Return what draws a page's pictures: noise instead of PNGs, as long as square ones."""
    random = np.random.default_rng(1)

    def drawer(width: int) -> tuple[bytes, dict[str, Pictures]]:
        size = 3 * min(width, widest) ** 2
        return random.bytes(size), {
            v.key: Pictures(random.bytes(size), random.bytes(size)) for v in variants
        }

    return drawer


def tiny_scene(path: Path | None = None, osl: bool = True) -> bpy.types.Scene:
    """Make a scene of 24 pixels with a sphere of ours; save it where a path is given."""
    from addon.material.node import new_material

    scene, sphere = small_scene(osl=osl)
    scene.render.resolution_x = scene.render.resolution_y = 24
    sphere.data.materials.append(new_material("CONDUCTOR", "Ours", Roughness=0.9))
    if path is not None:
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return scene


def dump() -> dict[str, object]:
    """Return the plain values of all that a scene is made of, by where they are."""
    found = {"filepath": bpy.data.filepath, "dirty": bpy.data.is_dirty}
    for kind in _KINDS:
        for data in getattr(bpy.data, kind):
            _dump(data, f"{kind}.{data.name_full}", found, _DEPTH)
    for kind in ("meshes", "texts"):
        found[kind] = [(data.name_full, data.users) for data in getattr(bpy.data, kind)]
    return found


def _dump(struct: bpy.types.bpy_struct, where: str, found: dict[str, object], depth: int) -> None:
    for prop in struct.bl_rna.properties:
        name = prop.identifier
        # Pictures of materials are no part of the file's content; deprecated ones warn.
        if name in ("rna_type", "preview") or getattr(prop, "is_deprecated", False):
            continue
        value = getattr(struct, name, None)
        if prop.type == "POINTER":
            if isinstance(value, bpy.types.ID) and not value.is_embedded_data:
                found[f"{where}.{name}"] = value.name_full
            elif value is not None and depth == _DEPTH:  # those deeper lead round in circles
                _dump(value, f"{where}.{name}", found, depth - 1)
        elif prop.type == "COLLECTION":
            for number, item in enumerate(value if depth and value is not None else ()):
                if isinstance(item, bpy.types.ID):
                    found[f"{where}.{name}[{number}]"] = item.name_full
                else:
                    _dump(item, f"{where}.{name}[{number}]", found, depth - 1)
        else:
            plain = tuple(value) if getattr(prop, "is_array", False) else value
            found[f"{where}.{name}"] = repr(plain)
