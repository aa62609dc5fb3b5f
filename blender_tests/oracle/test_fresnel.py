# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresnel factors against closed forms."""

import numpy as np
import pytest

from osl.oracle import F82Tint, IndexOfRefraction, White

GOLD = ((0.95, 0.75, 0.35), (0.98, 0.95, 0.75))
COPPER = ((0.20, 0.92, 1.10), (3.91, 2.45, 2.14))


def schlick(cosine, f0):
    return f0 + (1.0 - f0) * (1.0 - cosine) ** 5


def test_white_is_one():
    np.testing.assert_array_equal(White()(np.linspace(0.0, 1.0, 5)), np.ones((5, 1)))


def test_edge_tint_scales_schlick_at_one_seventh():
    base, tint = map(np.array, GOLD)
    value = F82Tint(*GOLD)(np.array(1.0 / 7.0))
    np.testing.assert_allclose(value, tint * schlick(1.0 / 7.0, base), rtol=1e-13)


def test_tinted_factor_at_the_ends_and_without_tint():
    base = np.array(GOLD[0])
    np.testing.assert_allclose(F82Tint(*GOLD)(np.array(1.0)), base, rtol=1e-15)
    np.testing.assert_allclose(F82Tint(*GOLD)(np.array(0.0)), np.ones(3), rtol=1e-15)
    c = np.linspace(0.0, 1.0, 11)
    plain = F82Tint(GOLD[0])(c)
    np.testing.assert_allclose(plain, schlick(c[:, None], base), rtol=1e-14)


def test_black_tint_is_clamped_at_zero():
    # without the clamp F82 = 0 would make the factor negative next to cos = 1/7
    value = F82Tint((0.02,) * 3, (0.0,) * 3)(np.linspace(0.0, 1.0, 1001))
    assert value.min() == 0.0
    assert value.max() <= 1.0


def test_index_at_normal_incidence():
    n, k = map(np.array, COPPER)
    expected = ((n - 1.0) ** 2 + k**2) / ((n + 1.0) ** 2 + k**2)
    np.testing.assert_allclose(IndexOfRefraction(*COPPER)(np.array(1.0)), expected, rtol=1e-13)


def test_index_without_absorption_vanishes_for_p_at_brewsters_angle():
    # tan(theta) = n: only the s wave reflects, with amplitude (n^2 - 1)/(n^2 + 1)
    n = 1.5
    value = IndexOfRefraction((n,) * 3, (0.0,) * 3)(np.cos(np.arctan(np.array(n))))
    np.testing.assert_allclose(value, 0.5 * ((n * n - 1.0) / (n * n + 1.0)) ** 2, rtol=1e-12)


def test_index_at_grazing_and_total_reflection():
    assert IndexOfRefraction(*COPPER)(np.array(0.0)) == pytest.approx(np.ones(3), abs=1e-7)
    c = np.linspace(0.0, 1.0, 9)
    pure = IndexOfRefraction((0.0,) * 3, (2.0,) * 3)(c)  # no real part: nothing is absorbed
    np.testing.assert_allclose(pure, 1.0, rtol=1e-13)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: F82Tint((0.5, 0.5, 1.2)), r"base_color is \(0\.5, 0\.5, 1\.2\)"),
        (lambda: F82Tint((0.5, 0.5, 0.5), (0.5, -0.1, 0.5)), "edge_tint"),
        (lambda: F82Tint((0.5, 0.5)), "three finite numbers"),
        (lambda: IndexOfRefraction((1.0, np.nan, 1.0), (1.0, 1.0, 1.0)), "n is"),
        (lambda: IndexOfRefraction((1.0, 0.0, 1.0), (1.0, 0.0, 1.0)), "one must exceed 0"),
    ],
)
def test_bad_values_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()
