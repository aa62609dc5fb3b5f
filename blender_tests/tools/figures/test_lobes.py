# SPDX-License-Identifier: GPL-3.0-or-later
"""How exits are counted, merged and compared."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from osl.oracle.materials import Conductor
from osl.oracle.vectors import direction
from tools.figures.findings import lobe_distance
from tools.figures.lobes import (
    BOUNCES,
    LOBES,
    PLANE_WIDTH,
    Lobes,
    by_lobe,
    gather,
    incident,
    plane_angles,
)
from tools.figures.traced import Traced


def exits(*directions, weight=1.0):
    """A bounce at which walks leave in the given directions."""
    towards = np.array(directions, dtype=float).reshape(-1, 3)
    leaving = np.full((len(towards), 1), weight)
    return SimpleNamespace(
        direction=towards,
        below_after=towards[:, 2] < 0.0,
        leaving=leaving,
        staying=1.0 - leaving,
    )


def test_a_mirror_sends_light_to_psi_theta():
    wi = incident(0.5)
    mirrored = np.array([-wi[0], 0.0, wi[2]])
    lobes = Lobes.merge(gather(iter([[exits(mirrored)]] * 2), 1))
    bin_ = np.abs(plane_angles() - 0.5).argmin()
    assert lobes.plane.mean[0, bin_] * PLANE_WIDTH == pytest.approx(1.0)
    assert lobes.plane.mean.sum() * PLANE_WIDTH == pytest.approx(1.0)


def test_energies_are_kept_by_bounce_and_side():
    up, down = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    walk = [exits(up, weight=0.5), exits(up, down, weight=0.25), *[exits(down)] * (BOUNCES + 1)]
    lobes = Lobes.merge(gather(iter([walk, walk]), 10))
    assert lobes.energies.mean[0] == pytest.approx([0.05, 0.0])
    assert lobes.energies.mean[1] == pytest.approx([0.025, 0.025])
    assert lobes.energies.mean[-1] == pytest.approx([0.0, 0.4])  # the last row takes the rest
    assert lobes.total.mean == pytest.approx(lobes.energies.mean.sum(axis=0))
    assert by_lobe(lobes.energies.mean).sum(axis=0) == pytest.approx(lobes.total.mean)
    in_lobes = lobes.plane.mean.sum(axis=1) * PLANE_WIDTH
    assert in_lobes == pytest.approx(by_lobe(lobes.energies.mean).sum(axis=1))
    assert lobes.halves.sum(axis=2) == pytest.approx(np.stack([in_lobes, in_lobes]))


def test_stretched_sheets_have_the_slopes_of_the_surface():
    task = Traced((1.0, 0.1), (Conductor(),), (0.0,), (0, 1), 16, 64)
    plain = replace(task, stretched=False)
    for number in task.sheets:
        exact = task.sheet(number).slope_statistics().variance
        np.testing.assert_allclose(exact, [0.5, 0.005], rtol=1e-12)
        # one sheet of 8 correlation lengths a side scatters by 1.5 / 8
        other = plain.sheet(number).slope_statistics().variance / [0.5, 0.005]
        assert np.all((np.abs(other - 1.0) > 1e-3) & (np.abs(other - 1.0) < 0.75))


def test_a_lambertian_surface_draws_half_a_cosine():
    rng = np.random.default_rng(1)
    theta = np.arcsin(np.sqrt(rng.random(200_000)))
    towards = direction(theta, 2.0 * np.pi * rng.random(theta.size))
    lobes = Lobes.merge(gather(iter([[exits(half)] for half in np.split(towards, 10)]), 20_000))
    z = (lobes.plane.mean[0] - 0.5 * np.maximum(np.cos(plane_angles()), 0.0))[60:180]
    z /= lobes.plane.error[0, 60:180]
    # 120 bins, errors from 10 parts: each z is of Student's distribution, variance 9/7
    assert np.mean(z * z) == pytest.approx(9.0 / 7.0, abs=4.0 * np.sqrt(2.0 * (9 / 7) ** 2 / 120))


def test_errors_are_the_scatter_of_the_parts():
    up = (0.0, 0.0, 1.0)
    parts = [[exits(up, weight=weight)] for weight in (0.2, 0.4, 0.6, 0.8)]
    whole = Lobes.merge(gather(iter(parts), 1))
    merged = Lobes.merge(gather(iter(parts[:2]), 1), gather(iter(parts[2:]), 1))
    expected = np.std([0.2, 0.4, 0.6, 0.8], ddof=1) / 2.0
    for lobes in (whole, merged):
        assert lobes.total.mean[0] == pytest.approx(0.5)
        assert lobes.total.error[0] == pytest.approx(expected)


def random_lobes(rng, shift=0.0):
    """Lobes with a cell of 0.1 + shift, another of 0.1 - shift, the rest and all noise equal."""
    halves = np.full((2, LOBES, 50), 0.1) + 0.001 * rng.standard_normal((2, LOBES, 50))
    halves[:, 1, 0] += shift
    halves[:, 1, 1] -= shift
    return SimpleNamespace(halves=halves)


def test_distance_is_what_goes_elsewhere_and_noise_is_told_from_it():
    rng = np.random.default_rng(2)
    distance, noise = lobe_distance(random_lobes(rng, 0.5), random_lobes(rng))
    assert distance[1] == pytest.approx(0.5, abs=0.04)
    assert distance[-1] == pytest.approx(0.5, abs=0.1)
    # 50 cells, |difference of means| of standard deviation 0.001: 50/2 sqrt(2/pi) 0.001 = 0.020
    np.testing.assert_allclose(noise[:-1], 0.020, rtol=0.4)
    np.testing.assert_allclose(distance[[0, 2, 3, 4]], noise[[0, 2, 3, 4]], rtol=0.5)
