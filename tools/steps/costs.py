# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the time of a sample of a pixel for each kind of material and step."""

from collections.abc import Iterable
from functools import partial

import bpy

from addon.core.analysis.step_errors import STEPS
from addon.core.kinds import KINDS
from addon.material.node import new_material
from addon.scene.share import picture_shares
from scenes import mixed
from scenes.timing import time_samples

ALPHAS = (0.04, 0.25, 1.0)
ROUNDS = 3
SAMPLES = 48
SIZE = (125, 100)
BASE = ("CONDUCTOR", "Single", 0.25)
_EMPTY = ("EMPTY",)


def measure(
    kinds: Iterable[str] = tuple(KINDS),
    alphas: Iterable[float] = ALPHAS,
    samples: int = SAMPLES,
    rounds: int = ROUNDS,
) -> tuple[list[dict], float]:
    """Return rows of costs, and the cost of a pixel of the world, all relative to BASE.

    Each kind, step and alpha covers all spheres of the scene of mixed materials in turn. They must
    include BASE. The time of the world around the spheres is subtracted.
    """
    scene = mixed.build(resolution=SIZE)
    spheres = [thing for thing in scene.objects if thing.type == "MESH"]

    def show(material: bpy.types.Material | None) -> None:
        for sphere in spheres:
            sphere.hide_render = material is None
            if material is not None:
                sphere.data.materials[0] = material

    switches = {_EMPTY: partial(show, None)}
    for kind in kinds:
        for alpha in alphas:
            for step in STEPS:
                name = f"{kind.title()} {alpha} {step}"
                made = new_material(kind, name, Roughness=alpha**0.5, Quality=step)
                switches[kind, step, alpha] = partial(show, made)
    switches[BASE]()
    (covered,) = picture_shares(bpy.context).by_name.values()
    times = time_samples(scene, switches, samples=samples, rounds=rounds)
    empty = times.ratio(_EMPTY, BASE)
    around = (1.0 - covered) * empty

    def cost(*variant: object) -> float:
        return (times.ratio(variant, BASE) - around) / (1.0 - around)

    rows = [
        {"kind": kind, "step": step, "costs": [cost(kind, step, alpha) for alpha in alphas]}
        for kind in kinds
        for step in STEPS
    ]
    return rows, empty * covered / (1.0 - around)
