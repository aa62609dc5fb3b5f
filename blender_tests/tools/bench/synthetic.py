# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings for tests, made up of known cost, noise and bias."""

import math
from collections.abc import Mapping

import numpy as np

from addon.core.cost.statistics import ErrorSplit
from tools.bench.curves import Curve
from tools.bench.findings import SceneFindings
from tools.bench.machine import Machine
from tools.bench.plan import Scene

MACHINE = Machine("Some processor", 2, "Linux x86_64", "5.2.3")
ROUNDS = 7


def curve(
    name: str,
    seconds: float,
    noise: float = 1.0,
    bias: float = 0.0,
    load: np.ndarray | None = None,
    levels: int = 11,
) -> Curve:
    """A curve whose squared error at n samples is bias^2 + noise^2 / n.

    seconds -- processor time of a sample
    load    -- a factor on it for each round
    """
    samples = tuple(1 << power for power in range(levels))
    squared = tuple(bias**2 + noise**2 / count for count in samples)
    cpu = tuple(float(seconds * factor) for factor in (np.ones(ROUNDS) if load is None else load))
    split = ErrorSplit(bias**2, (1e-4 * max(bias, noise)) ** 2, noise)
    return Curve(
        name, samples, squared, squared, squared, cpu, cpu, (0.2,) * len(cpu), split, piece=0.01
    )


def scene_of(scene: Scene, curves: Mapping[str, Curve]) -> SceneFindings:
    """Findings of a scene of the plan with these curves."""
    return SceneFindings(scene, dict(curves), 1e-6, 1000, MACHINE)


def timed(
    scene: Scene, seconds: Mapping[str, float], load: np.ndarray | None = None
) -> SceneFindings:
    """Findings without errors, from seconds of a sample by variant.

    load -- factors on them, (variants, rounds)
    """
    curves = {}
    for number, (name, time) in enumerate(seconds.items()):
        found = curve(name, time, load=None if load is None else load[number])
        nothing = (math.nan,) * len(found.samples)
        curves[name] = Curve(
            name, found.samples, nothing, nothing, nothing, found.cpu, found.wall, found.start
        )
    return scene_of(scene, curves)
