# SPDX-License-Identifier: GPL-3.0-or-later
"""What Walk and Exact cost: the time of a sample of the showcase over Single's, in one run."""

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
    metals = variants.find_materials()
    times = time_samples(
        bpy.context.scene,
        {
            quality: lambda quality=quality: variants.use_quality(metals, quality)
            for quality in ("Single", "Walk", "Exact")
        },
        samples=8,
        rounds=ROUNDS,
    )
    for quality, limit in (("Walk", f"{LARGEST_RATIO}"), ("Exact", "")):
        ratios = times.ratios(quality, "Single")
        spread = f"{statistics.median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f})"
        name = f"showcase, time of a sample, {quality} / Single, {ROUNDS} rounds"
        report(name, spread, limit)
    assert times.ratio("Walk", "Single") <= LARGEST_RATIO
