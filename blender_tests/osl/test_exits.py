# SPDX-License-Identifier: GPL-3.0-or-later
"""The width and the horizon of smoothed exits (exits.h)."""

import numpy as np
import pytest

from osl.oracle.masking import exit_probability
from osl.oracle.ndf import sigma
from osl.oracle.surface import BECKMANN, Surface
from osl.oracle.vectors import direction, normalize
from osl.oracle.visible import sample

from .probe import evaluate


@pytest.mark.parametrize("alpha", [(0.15, 0.15), (0.15, 0.03)])
@pytest.mark.parametrize("theta_i", [0.3, 1.0])
@pytest.mark.parametrize("elevation", [0.01, 0.15, 0.4, 1.2])
def test_kernels_keep_their_energy(
    alpha: tuple[float, float], theta_i: float, elevation: float
) -> None:
    """A lobe about the half vector of an exit, divided by `fraction_above_horizon`, reflects its
    whole weight within 6 %: what the first-order fraction leaves, over the walk's exits, is below
    the 1 % that the furnace allows (see render/test_furnace.py)."""
    wi, o = direction(theta_i), direction(np.pi / 2 - elevation, 2.0)
    h = normalize(wi + o)
    y = normalize(np.cross(h, np.array([1.0, 0.0, 0.0])))
    axes = np.stack([np.cross(y, h), y, h])
    lobe = Surface(*alpha, BECKMANN)
    v = np.tile(axes @ wi, (40_000, 1))
    m = sample(v, lobe, np.random.default_rng(17))
    reflected = 2.0 * np.sum(v * m, axis=-1, keepdims=True) * m - v
    shadowing = exit_probability(v, reflected, lobe)
    energy = np.mean(shadowing * ((reflected @ axes)[:, 2] > 0.0))
    assert sigma(v[:1], lobe)[0] > 0.0
    fraction = evaluate(
        "exits.h",
        "Frame lobe = shading_frame(normalize(wi + o), vector(1, 0, 0));"
        "result = fraction_above_horizon(wi, o[2], lobe, alpha[0], alpha[1]);",
        wi=[wi],
        o=[o],
        alpha=[[*alpha, 0.0]],
    )[0, 0]
    assert 0.5 <= fraction <= 1.0
    assert abs(energy / fraction - 1.0) < 0.06
