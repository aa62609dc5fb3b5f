# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard arguments of the shader's functions, as hypothesis draws them: special values, and others.

Vectors are tuples and numbers are float32, so that what is printed of a case is what was rendered.
"""

import math

import numpy as np
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from osl.oracle.surface import BECKMANN, GGX, MODELS

# Angles from the horizon or from the normal, rad.
_CLOSE = (0.0, 1e-7, 1e-6, 1e-5, 5e-5, 1e-4)
_ALPHAS = (1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0)
_INDICES = (1.0, 1.0001, 1.0 / 1.0001, 0.2, 5.0, 1.5, 1.0 / 1.5, 0.01, 100.0)
_UNIFORMS = (0.0, 1e-7, 0.5, 1.0 - 2.0**-24, 1.0)


def single(value: float) -> float:
    """The float32 nearest to `value`."""
    return float(np.float32(value))


# Hypothesis crowds floats and large integers at small values; these it spreads.
_STEPS = 1000
_PART = st.integers(0, _STEPS).map(lambda step: step / _STEPS)


def _chosen_or_even(special: tuple[float, ...]) -> SearchStrategy[float]:
    """`special`, and numbers spread evenly over [0, 1]."""
    return st.sampled_from([single(value) for value in special]) | _PART.map(single)


def _even_logarithm(special: tuple[float, ...], low: float, high: float) -> SearchStrategy[float]:
    """`special`, and numbers whose logarithm is even between those of `low` and `high`."""
    chosen = st.sampled_from([single(value) for value in special])
    return chosen | _PART.map(lambda part: single(low * (high / low) ** part))


def unit_vector(from_normal: float, azimuth: float) -> tuple[float, float, float]:
    """The direction at this angle from +z; multiples of a right angle have exact components."""
    sine, cosine = math.sin(from_normal), math.cos(from_normal)
    x, y = sine * math.cos(azimuth), sine * math.sin(azimuth)
    return single(x), single(y), single(cosine)


def _near(angle: float, anchor: str, lower: bool, azimuth: float) -> tuple[float, float, float]:
    if anchor == "normal":
        x, y, z = unit_vector(angle, azimuth)
    else:
        x, y, _ = unit_vector(0.5 * math.pi - angle, azimuth)
        z = single(math.sin(angle))
    return x, y, -z if lower else z


ANGLE = _even_logarithm(_CLOSE, 1e-6, 0.5 * math.pi)
AZIMUTH = st.sampled_from([0.0, 0.5 * math.pi, 0.25 * math.pi, 0.7, 2.5, 4.0, 5.9])
# Unit vectors on the whole sphere.
DIRECTION = st.builds(_near, ANGLE, st.sampled_from(["normal", "horizon"]), st.booleans(), AZIMUTH)
# Cosines 0 to 1, crowded at both ends.
COSINE = st.builds(lambda angle, f: single(f(angle)), ANGLE, st.sampled_from([math.cos, math.sin]))
UNIFORM = _chosen_or_even(_UNIFORMS)
THREE_UNIFORMS = st.tuples(UNIFORM, UNIFORM, UNIFORM)
REFLECTANCE = _chosen_or_even((0.0, 1.0, 0.04, 0.5))
INDEX = _even_logarithm(_INDICES, 0.01, 100.0)
# n and k, from none at all to the largest that the shader takes.
METAL_INDEX = _even_logarithm((0.0, 1.0, 1.0001, 0.2, 5.0, 100.0), 1e-3, 100.0)
COLOUR = st.tuples(REFLECTANCE, REFLECTANCE, REFLECTANCE)
COMPLEX = st.tuples(METAL_INDEX, METAL_INDEX, METAL_INDEX)
# Logarithms of a height's distribution function.
LOG_U = _even_logarithm((1e-7, 1e-4, 1.0, 80.0), 1e-7, 80.0).map(lambda depth: -depth)
# What the tables and the fractions on one side are asked for.
NUMBER = _even_logarithm((0.0, 1e-4, 1.0, 9.0, 1e4), 1e-6, 1e4)


def _widths(pair: tuple[float, float], distribution: str, model: str) -> tuple[float, float, float]:
    return *pair, float(2 * MODELS.index(model) + (distribution == BECKMANN))


_ALPHA = _even_logarithm(_ALPHAS, 1e-4, 1.0)
_PAIR = (
    st.sampled_from([(1.0, single(0.001)), (single(0.001), 1.0)])
    | _ALPHA.map(lambda alpha: (alpha, alpha))
    | st.tuples(_ALPHA, _ALPHA)
)


def surfaces(
    distributions: tuple[str, ...] = (GGX, BECKMANN), models: tuple[str, ...] = MODELS
) -> SearchStrategy[tuple[float, float, float]]:
    """alpha_x, alpha_y, and the number of distribution and model that samples.SURFACE takes."""
    return st.builds(_widths, _PAIR, st.sampled_from(distributions), st.sampled_from(models))
