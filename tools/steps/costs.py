# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sample of the showcase costs with one material on all its bodies."""

from functools import partial

import bpy

from addon.core.kinds import KINDS
from addon.nodes.group import new_material
from blender_tests.render import pictures
from scenes import variants
from tools.timing import time_samples

STEPS = ("Single", "Fitted", "Walk")
ALPHAS = (0.04, 0.25, 0.64, 1.0)
ROUNDS = 3
SAMPLES = 24
PERCENTAGE = 25  # of the showcase's width and height
BASE = ("CONDUCTOR", "Single", 0.25)


def rows() -> list[dict]:
    """Time all kinds and steps at ALPHAS, over metal of alpha 0.25 in Single."""
    pictures.open_scene("showcase")
    scene = bpy.context.scene
    scene.render.resolution_percentage = PERCENTAGE
    metals = {metal.material for metal in variants.find_materials()}
    slots = [
        slot for thing in scene.objects for slot in thing.material_slots if slot.material in metals
    ]

    def show(material: bpy.types.Material, step: str) -> None:
        for slot in slots:
            slot.material = material
        variants.use_quality(variants.find_materials(), step)

    switches = {}
    for kind in KINDS:
        for alpha in ALPHAS:
            material = new_material(kind, f"{kind.title()} {alpha}", Roughness=alpha**0.5)
            for step in STEPS:
                switches[kind, step, alpha] = partial(show, material, step)
    times = time_samples(scene, switches, samples=SAMPLES, rounds=ROUNDS)
    return [
        {
            "kind": kind,
            "step": step,
            "costs": [times.ratio((kind, step, alpha), BASE) for alpha in ALPHAS],
        }
        for kind in KINDS
        for step in STEPS
    ]
