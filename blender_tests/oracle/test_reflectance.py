# SPDX-License-Identifier: GPL-3.0-or-later
"""A dielectric's reflectance against known values, its other side, and 60 digits."""

from decimal import Decimal, localcontext

import numpy as np
import pytest

from osl.oracle.fresnel import dielectric_reflectance

IORS = [1.1, 1.5, 2.4, 1.0 / 1.5]


@pytest.mark.parametrize("eta", [*IORS, 1.0001, 5.0, 0.2], ids=repr)
def test_reflectance_at_known_angles(eta):
    normal = float(dielectric_reflectance(np.array(1.0), eta))
    assert normal == pytest.approx(((eta - 1.0) / (eta + 1.0)) ** 2, rel=1e-12)
    # tan(theta) = eta: only the s wave reflects, with amplitude (eta^2 - 1)/(eta^2 + 1)
    brewster = float(dielectric_reflectance(np.cos(np.arctan(np.array(eta))), eta))
    assert brewster == pytest.approx(0.5 * ((eta**2 - 1.0) / (eta**2 + 1.0)) ** 2, rel=1e-11)
    assert float(dielectric_reflectance(np.array(0.0), eta)) == pytest.approx(1.0, rel=1e-15)
    # next to grazing 1 - F is 4 c / g for the s wave and 4 eta^2 c / g for the p wave, with
    # g = sqrt(eta^2 - 1)
    if eta > 1.1:
        c = 1e-7
        slope = 2.0 * (1.0 + eta * eta) / np.sqrt(eta * eta - 1.0)
        lost = 1.0 - float(dielectric_reflectance(np.array(c), eta))
        assert lost == pytest.approx(slope * c, rel=1e-5)
    if eta < 1.0:
        critical = np.sqrt(1.0 - eta * eta)
        beyond = critical * np.array([0.0, 0.5, 0.999, 1.0 - 1e-12])
        np.testing.assert_array_equal(dielectric_reflectance(beyond, eta), 1.0)
        assert float(dielectric_reflectance(np.array(critical * 1.001), eta)) < 0.95


def test_an_index_of_1_reflects_nothing():
    np.testing.assert_array_equal(dielectric_reflectance(np.linspace(0.0, 1.0, 11), 1.0), 0.0)


@pytest.mark.parametrize("eta", [*IORS, 1.0 + 1e-9, 1.0 - 1e-9, 5.0], ids=repr)
def test_reflectance_is_the_same_from_both_sides(eta):
    cos_i = np.linspace(0.01, 1.0, 40)
    sin_t = np.sqrt(1.0 - cos_i**2) / eta
    passes = sin_t < 1.0
    cos_t = np.sqrt(1.0 - sin_t[passes] ** 2)
    forward = dielectric_reflectance(cos_i[passes], eta)
    backward = dielectric_reflectance(cos_t, 1.0 / eta)
    assert passes.sum() > 5
    # cos_t and 1/eta are rounded: eta - 1 = 1e-9 keeps 7 digits, and F has its square; cos_t next
    # to the critical angle keeps 11 or more
    np.testing.assert_allclose(forward, backward, rtol=1e-6 if abs(eta - 1.0) < 1e-6 else 1e-11)


def reflectance_by_decimals(cosine, eta):
    """Fresnel's equations as they are printed, with 60 digits."""
    with localcontext() as context:
        context.prec = 60
        c, n = Decimal(float(cosine)), Decimal(float(eta))
        square = 1 - (1 - c * c) / (n * n)
        if square <= 0:
            return 1.0
        t = square.sqrt()
        r_s, r_p = (c - n * t) / (c + n * t), (n * c - t) / (n * c + t)
        return float((r_s * r_s + r_p * r_p) / 2)


@pytest.mark.parametrize(
    "eta", [*IORS, 0.2, 5.0, 1.0 + 1e-9, 1.0 - 1e-9, 1.0 + 2.0**-40, 1.0001], ids=repr
)
def test_reflectance_keeps_its_digits(eta):
    cosines = np.array([1e-6, 1e-3, 0.1, 0.5, 0.7, 0.9, 0.999, 1.0])
    expected = [reflectance_by_decimals(c, eta) for c in cosines]
    found = dielectric_reflectance(cosines, eta)
    # measured: 3e-14 (the p wave of eta = 1 + 1e-9 vanishes near 0.7, where s alone is left)
    np.testing.assert_allclose(found, expected, rtol=1e-13)
