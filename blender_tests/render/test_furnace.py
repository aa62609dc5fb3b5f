# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnace: a surface that loses nothing, in a uniform world of radiance 1, shows radiance 1.

That is the analytic answer for every alpha: each path leaves in the end, whichever way it goes, and
meets the same radiance.
"""

import numpy as np
import pytest

from . import pictures
from .pictures import Widths

WIDTHS = [Widths(a, a) for a in (0.01, 0.25, 0.5, 1.0)] + [Widths(1.0, 0.1)]
IDS = [widths.name for widths in WIDTHS]
DISTRIBUTIONS = ("GGX", "Beckmann")
MASK = pictures.reference("furnace_gold_ggx_0.5")["mask"]
# 32 bounces leave less than 1e-9 of any case, and no tolerance is asked for.
ALL = {"MaxBounces": 32, "Tolerance": 0.0}


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("widths", WIDTHS, ids=IDS)
def test_exact(distribution: str, widths: Widths, report) -> None:
    """Mirrors of weight 1: there is not even noise. 0.002 is what the product promises."""
    found = pictures.render_fixture(
        "furnace_conductor", 16, Quality="Exact", Distribution=distribution, **widths.inputs, **ALL
    )
    blocks = pictures.block_means(found, MASK)
    low, high = blocks.min(), blocks.max()
    name = f"furnace, Exact, {distribution} {widths.name}"
    report(name, f"{low:.4f} .. {high:.4f}", "1.000 +- 0.002")
    assert low >= 0.998
    assert high <= 1.002


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("widths", WIDTHS, ids=IDS)
def test_walk(distribution: str, widths: Widths, report) -> None:
    """Blocks of 64 pixels at 512 samples: their noise is below 0.002, the rest is the kernels'."""
    found = pictures.render_fixture(
        "furnace_conductor", 512, Quality="Walk", Distribution=distribution, **widths.inputs
    )
    blocks = pictures.block_means(found, MASK)
    low, mean, high = blocks.min(), found[MASK].mean(), blocks.max()
    name = f"furnace, Walk, {distribution} {widths.name}"
    report(name, f"{low:.4f} .. {high:.4f}, mean {mean:.4f}", "1.00 +- 0.01")
    assert low >= 0.99
    assert high <= 1.01


def test_coloured_exact_is_the_oracle(report) -> None:
    """Gold, alpha 0.5: every colour channel of every block within the noise of both (z-test)."""
    wanted = pictures.reference("furnace_gold_ggx_0.5")
    gold = {"BaseColor": (0.95, 0.75, 0.35), "EdgeTint": (0.98, 0.95, 0.75)}
    widths = Widths(0.5, 0.5)
    found, variance = pictures.seeds(
        "furnace_conductor", 32, 8, Quality="Exact", **gold, **widths.inputs, **ALL
    )
    z = pictures.block_z(found, variance, wanted["mean"], wanted["error"], wanted["mask"])
    report("furnace, Exact, gold: largest |z|", f"{np.abs(z).max():.2f} of {z.size}", "4.5")
    # Student's t of 8 x 64 samples a block is nearly normal; 4.5 is exceeded once in 1000 runs.
    assert np.abs(z).max() < 4.5
    assert abs(z.mean()) < 4.5 / np.sqrt(z.size / 3)  # channels go together
