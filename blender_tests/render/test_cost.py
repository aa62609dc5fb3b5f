# SPDX-License-Identifier: GPL-3.0-or-later
"""What a sample costs, in one run: Walk and Exact over Single on the showcase of metals, and Walk
over Cycles' own glass on the same scene made of glass."""

import statistics

import bpy
import pytest

from addon.nodes.group import new_material
from scenes import variants
from tools.timing import SampleTimes, time_samples

from . import pictures

ROUNDS = 7
PERCENTAGE = 50  # of the showcase's width and height
CYCLES = "Cycles Multiscatter GGX"
LARGEST_RATIO_TO_GLASS = 2.5


def test_walk_costs_at_most_twice_single(report) -> None:
    """All metals of the showcase."""
    _open_showcase()
    metals = variants.find_materials()
    switches = {
        quality: lambda quality=quality: variants.use_quality(metals, quality)
        for quality in ("Single", "Walk", "Exact")
    }
    times = time_samples(bpy.context.scene, switches, samples=32, rounds=ROUNDS)
    _report("showcase", times, "Walk", "Single", "2.0", report)
    _report("showcase", times, "Exact", "Single", "", report)
    assert times.ratio("Walk", "Single") <= 2.0


@pytest.mark.parametrize("roughness", [0.5, 0.7])
def test_walk_costs_at_most_two_and_a_half_times_cycles_glass(roughness: float, report) -> None:
    """The showcase with all that is metal in it made glass.

    A lone sphere in a uniform world is told beside it, without a limit: it is nothing but closures,
    so that its ratio is far higher than that of a picture, in which rays take time as well.
    """
    showcase = _time_glass(_showcase_of_glass(roughness), samples=16)
    name = f"showcase of glass, roughness {roughness}"
    _report(name, showcase, "Walk", CYCLES, str(LARGEST_RATIO_TO_GLASS), report)
    lone = _time_glass(_lone_sphere(roughness), samples=16)
    _report(f"lone glass sphere, roughness {roughness}", lone, "Walk", CYCLES, "", report)
    assert showcase.ratio("Walk", CYCLES) <= LARGEST_RATIO_TO_GLASS


def _open_showcase() -> None:
    pictures.open_scene("showcase")
    bpy.context.scene.render.resolution_percentage = PERCENTAGE


def _showcase_of_glass(roughness: float) -> variants.Material:
    """Open the showcase and give one glass of IOR 1.5 to all that has a material of ours."""
    _open_showcase()
    metals = [metal.material for metal in variants.find_materials()]
    glass = new_material("DIELECTRIC", "Glass", Roughness=roughness)
    for thing in bpy.context.scene.objects:
        for slot in thing.material_slots:
            if slot.material in metals:
                slot.material = glass
    (found,) = variants.find_materials()
    assert found.material == glass
    return found


def _lone_sphere(roughness: float) -> variants.Material:
    """Open the furnace of glass, and let light go on inside the sphere; return its material."""
    glass = pictures.open_scene("furnace_dielectric")
    glass.set("Roughness", roughness)
    scene = bpy.context.scene
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = 8
    for ray in ("diffuse", "glossy", "transmission", "shadow"):
        setattr(bpy.data.objects["Sphere"], f"visible_{ray}", True)
    return glass


def _time_glass(glass: variants.Material, samples: int) -> SampleTimes:
    """Seconds per sample of Walk and of Cycles' own glass of the same values."""
    switches = {
        "Walk": lambda: variants.use_quality([glass], "Walk"),
        CYCLES: lambda: variants.use_cycles_multiscatter([glass]),
    }
    return time_samples(bpy.context.scene, switches, samples=samples, rounds=ROUNDS)


def _report(scene: str, times: SampleTimes, ours: str, theirs: str, limit: str, report) -> None:
    """Median over interleaved rounds of the ratio of neighbouring times, warm-up excluded."""
    ratios = times.ratios(ours, theirs)
    spread = f"{statistics.median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f})"
    name = f"{scene}, time of a sample, {ours} / {theirs}, {len(ratios)} rounds"
    report(name, spread, limit)
