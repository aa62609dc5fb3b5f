# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sample costs, in one run: Walk and Exact over Single on the showcase, and glass over
Cycles' own glass."""

import statistics

import bpy
import pytest

from scenes import variants
from tools.timing import SampleTimes, time_samples

from . import pictures

ROUNDS = 5


def test_walk_costs_at_most_twice_single(report) -> None:
    """All metals of the showcase."""
    pictures.open_scene("showcase")
    metals = variants.find_materials()
    switches = {
        quality: lambda quality=quality: variants.use_quality(metals, quality)
        for quality in ("Single", "Walk", "Exact")
    }
    times = time_samples(bpy.context.scene, switches, samples=8, rounds=ROUNDS)
    _report("showcase", times, "Walk", "Single", "2.0", report)
    _report("showcase", times, "Exact", "Single", "", report)
    assert times.ratio("Walk", "Single") <= 2.0


@pytest.mark.parametrize("roughness", [0.5, 1.0])
def test_walk_costs_at_most_two_and_a_half_times_cycles_glass(roughness: float, report) -> None:
    """A sphere of glass in a uniform world, which light enters and leaves."""
    material = pictures.open_scene("furnace_dielectric")
    material.set("Roughness", roughness)
    scene = bpy.context.scene
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = 8
    for ray in ("diffuse", "glossy", "transmission", "shadow"):
        setattr(bpy.data.objects["Sphere"], f"visible_{ray}", True)

    def use_cycles(distribution: str) -> None:
        variants.use_cycles_multiscatter([material])
        native = material.material.node_tree.nodes[variants.CYCLES_OWN]
        native.distribution = distribution

    switches = {
        "Walk": lambda: variants.use_quality([material], "Walk"),
        "Cycles Multiscatter GGX": lambda: use_cycles("MULTI_GGX"),
        "Cycles GGX": lambda: use_cycles("GGX"),
    }
    times = time_samples(scene, switches, samples=32, rounds=ROUNDS)
    name = f"glass sphere of roughness {roughness}"
    _report(name, times, "Walk", "Cycles Multiscatter GGX", "2.5", report)
    _report(name, times, "Walk", "Cycles GGX", "", report)
    assert times.ratio("Walk", "Cycles Multiscatter GGX") <= 2.5


def _report(scene: str, times: SampleTimes, ours: str, theirs: str, limit: str, report) -> None:
    """Median over interleaved rounds of the ratio of neighbouring times, warm-up excluded."""
    ratios = times.ratios(ours, theirs)
    spread = f"{statistics.median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f})"
    report(f"{scene}, time of a sample, {ours} / {theirs}, {ROUNDS} rounds", spread, limit)
