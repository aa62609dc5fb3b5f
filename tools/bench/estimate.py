# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicts how long a plan takes on this machine, from the times of a trial run."""

import statistics
from collections.abc import Mapping, Sequence

from .findings import SceneFindings
from .plan import EXACT, Scene, levels


def seconds(plan: Sequence[Scene], trial: Mapping[str, SceneFindings]) -> float:
    """Seconds that the plan takes if nothing else runs, rather too many than too few.

    All cores share the samples. Starting a render and compiling shaders count as the work of one.
    """
    return sum(_scene(scene, trial[scene.name]) for scene in plan)


def _scene(scene: Scene, trial: SceneFindings) -> float:
    samples = starts = 0.0
    for variant in scene.variants:
        curve = trial.curves[variant.name]
        samples += sum(scene.tops) * curve.a_sample
        starts += sum(
            statistics.median(curve.start) + (1 + len(levels(top))) * curve.piece
            for top in scene.tops
        )
    if scene.reference_samples:
        samples += 2.0 * scene.reference_samples * trial.curves[EXACT].a_sample
    return samples / trial.machine.cores + starts
