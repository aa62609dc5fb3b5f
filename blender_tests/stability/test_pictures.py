# SPDX-License-Identifier: GPL-3.0-or-later
"""A crowd of 800 hard things: whatever the parameters and the geometry, every pixel is finite, not
negative and no brighter than the furnace, and the same seed gives the same picture.

In a world of radiance 1 nothing can show more than 1 on average. A thing's mean over its cell may
exceed that by 4 of its standard errors, which two seeds tell, and by the 0.01 that Walk's energy is
held to. A single sample can exceed it: it is divided by the chance of the lobe that it took, and a
lobe at the horizon is given twice its energy for what falls below; CAP bounds a pixel's mean of
SAMPLES of them. Cycles shows what is not finite as black: so flat things that lose nothing, with
their own normals, may not be darker than the furnace either, in the middle of their cell. (Where a
normal is turned from the surface, Cycles' own closures lose light as well.)
"""

import numpy as np
import pytest

from scenes import pictures

from .crowd import Thing, build, cells, draw
from .regressions import THINGS

COUNT = 800
FOLDED = 12
SAMPLES = 64
SLACK = 0.01
CAP = 3.0
DARKEST = 0.02


def faults(things: list[Thing]) -> list[str]:
    """What is wrong with the picture of each thing, in words; empty if nothing is."""
    build(things)
    first, again, other = (pictures.picture(SAMPLES, seed) for seed in (1, 1, 2))
    said = []
    both = zip(*(cells(image, len(things)) for image in (first, again, other)), strict=True)
    for thing, (a, b, c) in zip(things, both, strict=True):
        said.append(_fault(thing, a, b, c))
    return said


def _fault(thing: Thing, a: np.ndarray, again: np.ndarray, other: np.ndarray) -> str:
    """The same of one cell, whose pixels in the three pictures are given."""
    if not np.all(np.isfinite(a)):
        return "a pixel is not finite"
    if a.min() < 0.0:
        return f"a pixel is negative: {a.min():.3g}"
    if not np.array_equal(a, again):
        return f"the same seed gives another picture, by {np.abs(a - again).max():.3g}"
    if a.max() > CAP:
        return f"a pixel shows {a.max():.3f}"
    mean, error = _mean(a, other)
    if np.any(mean > 1.0 + SLACK + 4.0 * error):
        return f"shows {mean.max():.4f} +- {error.max():.4f}, more than the furnace"
    if thing.lossless and thing.plain:
        mean, error = _mean(a[3:-3, 3:-3], other[3:-3, 3:-3])
        if np.any(mean < DARKEST):
            return f"is black: {mean.min():.4f}"
        full = thing.inputs["Quality"] > 0
        if full and np.any(mean < 1.0 - SLACK - 4.0 * error):
            return f"shows {mean.min():.4f} +- {error.max():.4f}, less than the furnace"
    return ""


def _mean(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean of two independent pictures (rows, columns, 3), and its standard error, (3,)."""
    # Their difference has twice the variance of one, four times that of their mean.
    error = np.sqrt(np.mean((a - b) ** 2, axis=(0, 1)) / (4.0 * a[..., 0].size))
    return 0.5 * (a + b).mean(axis=(0, 1)), error


@pytest.mark.parametrize("nested", [False, True], ids=["single", "nested"])
def test_crowd(nested: bool, report) -> None:
    """Glass in glass has a picture of its own: it alone is seen by all rays, and would shade the
    others."""
    things = [thing for thing in draw(COUNT, FOLDED, seed=1) if thing.nested == nested]
    said = faults(things)
    wrong = [f"{what}: {thing!r}" for what, thing in zip(said, things, strict=True) if what]
    name = f"stability, {'nested glass' if nested else 'things'} of the crowd"
    report(name, f"{len(wrong)} of {len(things)} fail", "0")
    assert not wrong, "\n".join([f"{len(wrong)} of {len(things)}:", *wrong])


def test_crowd_is_large() -> None:
    assert COUNT >= 300
    assert 50 < sum(thing.nested for thing in draw(COUNT, FOLDED, seed=1)) < COUNT - 300


def test_seeds_differ() -> None:
    """The comparison above would see a change."""
    build(draw(20, 0, seed=1))
    assert not np.array_equal(pictures.picture(1, 1), pictures.picture(1, 2))


@pytest.mark.parametrize("name", THINGS)
def test_regressions(name: str) -> None:
    kept = THINGS[name]
    assert faults([kept.thing]) == [""], kept.was
