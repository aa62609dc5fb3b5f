# SPDX-License-Identifier: GPL-3.0-or-later
"""The deficit of a Gaussian tail against its integral and asymptote."""

import numpy as np
import pytest

from osl.oracle.error_function import INV_SQRT_PI, deficit
from osl.oracle.quadrature import gauss_legendre

# Measured 1.2e-14; the rule used here has rounding of its own.
RELATIVE = 1e-13


@pytest.mark.parametrize("x", [0.0, 1e-8, 0.1, 0.5, 1.0, 1.9, 3.0, 5.0, 12.0, 26.0, 100.0, 1e4])
def test_values_equal_their_integrals(x):
    # erfcx(x) = 2/sqrt(pi) * integral of exp(-t^2 - 2 x t), and the deficit is minus half its slope
    t, weight = gauss_legendre(120, 0.0, min(7.0, 20.0 / max(x, 1e-9)))
    kernel = 2.0 * INV_SQRT_PI * weight * np.exp(-t * t - 2.0 * x * t)
    assert float(deficit(x)) == pytest.approx((t * kernel).sum(), rel=RELATIVE)


def test_far_asymptotes():
    x = np.array([1e9, 1e100, 1e150])
    np.testing.assert_allclose(deficit(x), 0.5 * INV_SQRT_PI / x**2, rtol=RELATIVE)
