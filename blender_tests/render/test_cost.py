# SPDX-License-Identifier: GPL-3.0-or-later
"""What Walk costs: the time of a sample of the showcase, relative to Single in the same run."""

import statistics

import bpy

from scenes import variants
from tools.timing import time_samples

from . import pictures

LARGEST_RATIO = 2.0
ROUNDS = 5


def test_walk_costs_at_most_twice_single(report) -> None:
    """Median over interleaved rounds of the ratio of neighbouring times, warm-up excluded."""
    pictures.open_scene("showcase")
    metals = variants.find_metals()
    times = time_samples(
        bpy.context.scene,
        {
            "Single": lambda: variants.use_quality(metals, "Single"),
            "Walk": lambda: variants.use_quality(metals, "Walk"),
        },
        samples=8,
        rounds=ROUNDS,
    )
    ratios = times.ratios("Walk", "Single")
    ratio = statistics.median(ratios)
    spread = f"{ratio:.2f} ({min(ratios):.2f} .. {max(ratios):.2f}, {ROUNDS} rounds)"
    report("showcase, time of a sample, Walk / Single", spread, f"{LARGEST_RATIO}")
    assert ratio <= LARGEST_RATIO
