# SPDX-License-Identifier: GPL-3.0-or-later
"""The balanced dielectric has the plain one's means, and less noise in reflected light."""

from dataclasses import replace

import numpy as np
import pytest

from osl.oracle import GGX, HEIGHT_TRACKED, Dielectric, Surface, bidirectional, energies, evaluate
from osl.oracle.balanced import BalancedDielectric
from osl.oracle.reference_cases import CASES, GLASS
from osl.oracle.vectors import direction
from osl.oracle.view import to_local

pytestmark = pytest.mark.nightly


@pytest.mark.parametrize("ior", [1.5, 1.0 / 1.5])
def test_energies_are_the_dielectrics(ior):
    wi = direction(np.array([0.1, 1.2]))
    found, wanted = (
        energies(wi, Surface(0.7, 0.7, GGX, kind(ior)), 8, 100_000, 1, roulette=0.0)
        for kind in (BalancedDielectric, Dielectric)
    )
    for part in ("reflected", "transmitted"):
        a, b = getattr(found, part), getattr(wanted, part)
        seen = b.mean[..., 0] > 1e-3
        z = (a.mean - b.mean)[..., 0] / np.sqrt(a.variance + b.variance + 1e-20)[..., 0]
        assert seen.sum() >= 4
        # a right one fails once in 16 000 comparisons
        assert np.abs(z[seen]).max() < 4.0


@pytest.mark.parametrize("model", ["CORRELATED", HEIGHT_TRACKED])
def test_reflected_light_has_less_noise(model):
    """The references need the reflected part of the bounces after the first."""
    wi, wo = direction(0.4), direction(0.9, 2.0)
    found, wanted = (
        evaluate(wi, wo, Surface(1.0, 1.0, GGX, kind(1.5), model), 16, 200_000, 2)
        for kind in (BalancedDielectric, Dielectric)
    )
    difference = found.total[0] - wanted.total[0]
    variance = found.total_variance[0], wanted.total_variance[0]
    assert abs(difference) < 4.0 * np.sqrt(sum(variance))
    assert variance[0] < 0.5 * variance[1]


@pytest.mark.parametrize(
    "case",
    [c for c in CASES if c.surface.material is GLASS and c.surface.model != HEIGHT_TRACKED],
    ids=lambda case: case.name,
)
def test_pictures_miss_no_peak_of_the_bidirectional_estimator(case):
    """Both estimators agree on some of a reference's points, up to 8 bounces."""
    view = case.light.view(resolution=18, subsamples=1)
    axes = [axis[view.mask][:, 0][::3] for axis in view.axes]
    wi = to_local(view.viewer[view.mask][:, 0][::3], axes)
    wo = to_local(case.light.sun, axes)
    one = evaluate(wi, wo, case.surface, 8, 4000, 3)
    plain = replace(case.surface, material=Dielectric(case.surface.material.ior))
    two = bidirectional.evaluate(wi, wo, plain, 8, 400, 4)
    np.testing.assert_array_equal(one.mean[0], two.mean[0])
    difference = (one.total - two.total)[:, 0]
    variance = (one.total_variance + two.total_variance)[:, 0]
    assert abs(difference.sum()) < 4.0 * np.sqrt(variance.sum())
    # and no pixel is off by more than its noise and 1 % of the brightest
    brightest = one.total[:, 0].max()
    assert np.all(np.abs(difference) < 5.0 * np.sqrt(variance) + 0.01 * brightest)
