# SPDX-License-Identifier: GPL-3.0-or-later
"""The split of errors recovers a known bias and a known noise, and its standard error is right."""

import math

import numpy as np
import pytest

from addon.core.cost.statistics import (
    ErrorSplit,
    error_after,
    reference_noise,
    samples_to_error,
    split_error,
)

SIZE = (32, 40, 3)
NOISE, REFERENCE_NOISE = 0.3, 0.1
REPEATS = 300


def _noise(random, strength, smooth):
    """Return noise of that strength; `smooth` makes neighbours alike, as a pixel filter does."""
    noise = random.normal(size=SIZE)
    if smooth:
        noise = noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1) + np.roll(noise, (1, 1), (0, 1))
        noise /= 2.0
    return strength * noise


def _splits(bias, rounds=3, smooth=False, repeats=REPEATS):
    """Return splits of pictures of a gradient that are wrong by `bias` up in one half, down in
    the other, and the root mean square of the truth.
    """
    random = np.random.default_rng(5)
    truth = np.broadcast_to(np.linspace(0.5, 1.5, SIZE[1])[None, :, None], SIZE)
    wrong = truth + bias * np.where(np.arange(SIZE[0]) % 2, 1.0, -1.0)[:, None, None]
    splits = [
        split_error(
            [wrong + _noise(random, NOISE, smooth) for _ in range(rounds)],
            [truth + _noise(random, REFERENCE_NOISE, smooth) for _ in range(2)],
        )
        for _ in range(repeats)
    ]
    return splits, math.sqrt(np.mean(truth**2))


@pytest.mark.parametrize("bias", [0.0, 0.03, 0.2])
@pytest.mark.parametrize("rounds", [2, 4])
def test_known_bias_and_noise_are_recovered(bias, rounds):
    splits, level = _splits(bias, rounds)
    squares = np.array([s.bias_square for s in splits])
    own = squares.std(ddof=1) / math.sqrt(REPEATS)
    assert abs(squares.mean() - (bias / level) ** 2) < 4.0 * own
    assert np.mean([s.noise for s in splits]) == pytest.approx(NOISE / level, rel=0.01)


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("bias", [0.0, 0.2])
def test_the_standard_error_is_the_scatter_of_the_estimate(bias, smooth):
    splits, _ = _splits(bias, smooth=smooth)
    scatter = np.std([s.bias_square for s in splits], ddof=1)
    told = math.sqrt(np.mean([s.bias_square_se**2 for s in splits]))
    assert 0.8 < told / scatter < 1.4


def test_no_bias_is_not_resolved_and_a_large_one_is():
    none, _ = _splits(0.0)
    assert sum(s.resolved for s in none) < 0.02 * REPEATS
    large, level = _splits(0.2)
    assert all(s.resolved for s in large)
    within = [abs(s.bias - 0.2 / level) < 3.0 * s.bias_se for s in large]
    assert sum(within) > 0.97 * REPEATS


def test_noise_of_the_reference():
    random = np.random.default_rng(2)
    pictures = [1.0 + 0.2 * random.normal(size=SIZE) for _ in range(2)]
    assert reference_noise(pictures) == pytest.approx(0.2 / math.sqrt(2.0), rel=0.05)


def test_an_estimate_below_zero_is_no_bias():
    split = ErrorSplit(-1e-4, 1e-4, 0.1)
    assert split.bias == 0.0
    assert not split.resolved
    assert split.resolution == pytest.approx(math.sqrt(3e-4))
    assert split.doubtful(0.01)
    assert not split.doubtful(0.1)


def test_samples_to_an_error_and_back():
    split = ErrorSplit(0.01**2, 0.0, 0.08)
    samples = samples_to_error(split, 16, 0.02)
    assert samples == pytest.approx(16 * 0.08**2 / (0.02**2 - 0.01**2))
    assert error_after(split, samples / 16) == pytest.approx(0.02)
    assert samples_to_error(split, 16, 0.01) == math.inf
    assert error_after(split, 1e12) == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("pictures", "references", "message"),
    [
        (1, 2, "2 or more and 2 are needed"),
        (2, 1, "2 or more and 2 are needed"),
        (2, 3, "2 or more and 2 are needed"),
    ],
)
def test_wrong_numbers_of_pictures(pictures, references, message):
    one = np.ones(SIZE)
    with pytest.raises(ValueError, match=message):
        split_error([one] * pictures, [one] * references)


def test_pictures_that_do_not_fit():
    one = np.ones(SIZE)
    with pytest.raises(ValueError, match="render them anew"):
        split_error([one, one[1:]], [one, one])
    with pytest.raises(ValueError, match="not numbers"):
        split_error([one, np.full(SIZE, np.nan)], [one, one])
    with pytest.raises(ValueError, match="The reference is black"):
        split_error([one, one], [0 * one, 0 * one])
