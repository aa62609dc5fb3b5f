# SPDX-License-Identifier: GPL-3.0-or-later
"""The analysis keeps its promises on a small scene of mixed materials."""

import time

import bpy
import numpy as np
import pytest

from addon.analysis.analyse import analyse, apply_analysis
from addon.analysis.surfaces import found_nodes, read_choice
from addon.core.analysis.prediction import Choice
from addon.scene.share import shown_materials
from scenes import mixed, mixed_demo

COUNT, SIZE = 6, (48, 32)
TOLERANCE = 0.03


@pytest.mark.nightly
def test_the_measured_error_is_within_the_tolerance(report) -> None:
    """The converged picture, of two renders, against two of Exact. So is the predicted error."""
    mixed.build(COUNT, SIZE)
    found = mixed_demo.AnalysedScene(TOLERANCE)
    predicted = found.predicted(mixed_demo.ANALYSED)
    assert 0.0 < predicted <= TOLERANCE
    wanted = found.pictures("Exact", 768, first_seed=100)
    error, spread = mixed_demo.difference(
        found.pictures(mixed_demo.ANALYSED, 192, first_seed=0), wanted
    )
    value = f"{error:.2%} +- {spread:.2%}, predicted {predicted:.2%}"
    report("analysed scene of six materials, error", value, f"{TOLERANCE:.0%}")
    assert error + 2.0 * spread < TOLERANCE
    assert spread < 0.5 * TOLERANCE
    # Without further bounces the error is larger, so the test can fail.
    lost, _ = mixed_demo.difference(found.pictures("Single", 192, first_seed=0), wanted)
    assert lost > TOLERANCE


@pytest.mark.nightly
@pytest.mark.timing
def test_it_takes_less_time_than_walk(report) -> None:
    """Processor time of a whole render. The analysed one is rendered first, which also warms up."""
    scene = mixed.build(COUNT, (120, 80))
    scene.cycles.samples = 48
    found = mixed_demo.AnalysedScene(TOLERANCE)
    seconds = {}
    for variant in (mixed_demo.ANALYSED, "Walk"):
        found.switch(variant)
        begin = time.process_time()
        bpy.ops.render.render()
        seconds[variant] = time.process_time() - begin
    ratio = seconds[mixed_demo.ANALYSED] / seconds["Walk"]
    report("analysed scene of six materials, time of a render over Walk's", f"{ratio:.2f}", "0.9")
    assert ratio < 0.9


def test_twenty_materials_of_all_kinds() -> None:
    """All are found with similar shares. A second analysis proposes nothing."""
    mixed.build()
    found = found_nodes(shown_materials(bpy.context))
    assert len(found) == len(mixed.RECIPES) == 20
    assert {one.kind.identifier for one in found} == {"CONDUCTOR", "DIELECTRIC", "DIFFUSE"}
    first = analyse(bpy.context, 0.01)
    shares = [row.proposal.share for row in first.rows]
    # The spheres have one size, but some mirror others.
    assert np.ptp(shares) < 0.3 * np.mean(shares)
    assert not any(row.notes for row in first.rows)
    done, left = apply_analysis(bpy.context, first)
    assert len(done) == len(first.changes)
    assert left == []
    assert analyse(bpy.context, 0.01).changes == ()


def test_a_texture_gives_the_range_of_its_roughness() -> None:
    mixed.build()
    rows = {row.name: row.proposal for row in analyse(bpy.context, 0.01).rows}
    assert rows["Worn Nickel"].reason.startswith("alpha 0.04 to 0.56:")
    assert read_choice(found_nodes([bpy.data.materials["Clay"]])[0]) == Choice("Fitted", 16)
