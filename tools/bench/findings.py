# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the kept results of a plan's scenes as curves."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from addon.core.cost.statistics import ErrorSplit

from . import store
from .curves import Curve
from .errors import converged
from .machine import Machine
from .plan import Scene, Variant

# Relative; single precision shows no smaller one. Exact in a white furnace has no error at all.
SMALLEST_ERROR = 1e-5


class MissingResultError(RuntimeError):
    """A scene was not measured to its end. The message names it and the remedy."""


@dataclass(frozen=True)
class SceneFindings:
    """A scene with its curves by variant name.

    resolution -- squared error of the reference's own noise; nan without a reference
    pixels     -- number of pixels in the mask
    """

    scene: Scene
    curves: dict[str, Curve]
    resolution: float
    pixels: int
    machine: Machine


def read_scenes(scenes: Iterable[Scene], folder: Path) -> dict[str, SceneFindings]:
    """The findings of `scenes` by name. Raises MissingResultError if one lacks a run."""
    return {scene.name: read_scene(scene, folder) for scene in scenes}


def read_scene(scene: Scene, folder: Path) -> SceneFindings:
    """The findings of one scene. Raises MissingResultError if it lacks a run."""
    reference = _load(store.reference_path(folder, scene), scene)
    floor = float(reference["resolution"]) if "resolution" in reference else float("nan")
    curves = {
        variant.name: _curve(
            variant,
            [
                _load(store.run_path(folder, scene, variant, turn), scene)
                for turn in range(len(scene.tops))
            ],
            reference,
            floor,
        )
        for variant in scene.variants
    }
    machine = Machine(
        str(reference["cpu"]),
        int(reference["cores"]),
        str(reference["system"]),
        str(reference["blender"]),
    )
    return SceneFindings(scene, curves, floor, int(reference["mask"].sum()), machine)


def _curve(
    variant: Variant, runs: list[store.Result], reference: store.Result, floor: float
) -> Curve:
    """The curve of a variant's rounds.

    No error counts as smaller than the reference's noise or SMALLEST_ERROR.
    """
    longest = max(runs, key=lambda run: run["samples"][-1])["samples"]
    by_level = [
        [float(run["squared_error"][level]) for run in runs if level < len(run["samples"])]
        for level in range(len(longest))
    ]
    lowest_told = np.fmax(floor, SMALLEST_ERROR**2)
    lowest, squared, highest = (
        tuple(float(np.maximum(how(found), lowest_told)) for found in by_level)
        for how in (np.min, np.median, np.max)
    )
    return Curve(
        variant.name,
        tuple(int(count) for count in longest),
        squared,
        lowest,
        highest,
        tuple(float(run["cpu"]) for run in runs),
        tuple(float(run["wall"]) for run in runs),
        tuple(float(run["start"]) for run in runs),
        _bias(variant, runs, reference),
        float(np.median([run["piece"] for run in runs])),
    )


def _bias(variant: Variant, runs: list[store.Result], reference: store.Result) -> ErrorSplit | None:
    """The error of the converged picture, from the rounds that kept a picture."""
    if variant.percentage:  # the reference has another size
        return None
    pictures = [run["picture"] for run in runs if "picture" in run]
    return converged(pictures, reference, variant.name)


def _load(path: Path, scene: Scene) -> store.Result:
    found = store.load(path)
    if found is None:
        raise MissingResultError(
            f"{scene.name} lacks results, or the sources changed since: measure it again"
        )
    return found
