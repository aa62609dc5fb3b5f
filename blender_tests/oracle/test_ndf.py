# SPDX-License-Identifier: GPL-3.0-or-later
"""D, sigma, Lambda and Dvis against their definitions as integrals."""

import numpy as np
import pytest

from osl.oracle.ndf import D, Dvis, Lambda, sigma
from osl.oracle.quadrature import gauss_legendre, stretched_normals, visible_normals
from osl.oracle.surface import BECKMANN, GGX, Surface
from osl.oracle.vectors import direction, dot

WIDTHS = [(0.01, 0.01), (0.25, 0.25), (0.5, 0.5), (1.0, 1.0), (1.0, 0.1), (0.02, 0.4)]
# From straight up to straight down, through both sides of the horizon.
ANGLES = [0.0, 0.3, 1.0, 1.5, np.pi / 2 - 1e-6, np.pi / 2 + 1e-6, 1.65, 2.2, 3.0]
SURFACES = [Surface(x, y, ndf) for ndf in (GGX, BECKMANN) for x, y in WIDTHS]


def name(surface):
    return f"{surface.distribution}-{surface.alpha_x}-{surface.alpha_y}"


@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_projected_area_of_all_micronormals_is_one(surface):
    q, q_weight = gauss_legendre(200, 0.0, 1.0)
    psi = 2.0 * np.pi * np.arange(64) / 64
    m, measure = stretched_normals(*np.meshgrid(q, psi, indexing="ij"), surface)
    area = (D(m, surface) * m[..., 2] * measure * q_weight[:, None]).sum() * 2.0 * np.pi / 64
    assert area == pytest.approx(1.0, rel=1e-10)


@pytest.mark.parametrize("surface", SURFACES, ids=name)
@pytest.mark.parametrize("theta", ANGLES)
def test_sigma_is_the_projected_area_of_facing_micronormals(surface, theta):
    w = direction(theta, 0.7)
    m, weight = visible_normals(w, surface)
    expected = (np.maximum(dot(w, m), 0.0) * D(m, surface) * weight).sum()
    # 1e-7 is what the rule reaches; far below Beckmann's horizon both are smaller than 1e-30
    assert float(sigma(w, surface)) == pytest.approx(expected, rel=1e-7, abs=1e-30)


@pytest.mark.parametrize("surface", SURFACES, ids=name)
def test_sigma_of_opposite_directions_differs_by_the_cosine(surface):
    w = direction(np.linspace(0.0, np.pi, 181), 0.4)
    difference = sigma(w, surface) - sigma(-w, surface)
    np.testing.assert_allclose(difference, w[:, 2], rtol=0.0, atol=1e-15)
    assert np.all(sigma(w, surface) >= 0.0)


def test_sigma_below_the_horizon_keeps_its_digits():
    # alpha 1e-4, 1.5 rad below the horizon plane's normal: the naive forms give 0 or noise
    w = direction(np.pi / 2 + 0.5)
    surface = Surface(1e-4, 1e-4, GGX)
    t2, z = (1e-4 * w[0]) ** 2, abs(w[2])
    series = t2 / (4.0 * z) * (1.0 - t2 / (4.0 * z * z))  # of (r - |z|)/2 in t2
    assert float(sigma(w, surface)) == pytest.approx(series, rel=1e-12)


@pytest.mark.parametrize("theta", [0.2, 0.9, 1.4])
def test_lambda_of_ggx_in_closed_form(theta):
    # Smith's Lambda for GGX: (sqrt(1 + alpha^2 tan^2 theta) - 1) / 2; below the horizon -1 - it
    expected = 0.5 * (np.sqrt(1.0 + (0.6 * np.tan(theta)) ** 2) - 1.0)
    surface = Surface(0.6, 0.6, GGX)
    assert float(Lambda(direction(theta), surface)) == pytest.approx(expected, rel=1e-12)
    assert float(Lambda(-direction(theta), surface)) == pytest.approx(-1.0 - expected, rel=1e-12)


@pytest.mark.parametrize("surface", SURFACES, ids=name)
@pytest.mark.parametrize("theta", [0.0, 1.0, 1.55, 1.65, 2.2])
def test_visible_normals_are_normalised(surface, theta):
    w = direction(theta, 2.0)
    if sigma(w, surface) == 0.0:
        with pytest.raises(ValueError, match="no micronormal is visible"):
            Dvis(w, direction(0.1), surface)
        return
    m, weight = visible_normals(w, surface)
    assert (Dvis(w, m, surface) * weight).sum() == pytest.approx(1.0, rel=1e-7)


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
def test_no_micronormal_points_below_the_horizon(distribution):
    m = direction(np.array([np.pi / 2 + 1e-9, 2.0, np.pi]))
    np.testing.assert_array_equal(D(m, Surface(0.5, 0.5, distribution)), 0.0)
