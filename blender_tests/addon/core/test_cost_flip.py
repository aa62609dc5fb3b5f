# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP is 0 for equal pictures, symmetric, and the same as that of its authors' package.

The numbers below are those of the package `flip-evaluator` 1.7 (by the paper's authors) for the
pictures of `_pictures()`, given as float32:

    flip_evaluator.evaluate(reference, test, "LDR", applyMagma=False, inputsRGB=True)
"""

import numpy as np
import pytest

from addon.core.cost.flip import flip

MEAN = 0.19212757
# By row and column.
PIXELS = {(20, 30): 0.59755224, (10, 20): 0.47184703, (5, 5): 0.71363574, (20, 5): 0.0}
WHITE_ON_BLACK = 0.96739513


def _pictures():
    """Return a picture with gradients and rings, and one with a darker square, a line, a point."""
    y, x = np.mgrid[:48, :64]
    first = np.stack([x / 63, y / 47, 0.5 + 0.5 * np.sin(x * y / 150)], -1)
    second = first.copy()
    second[10:30, 20:40] *= 0.6
    second[:, 50:52] = 1 - second[:, 50:52]
    second[5, 5] = 1
    return first, second


def test_same_as_the_authors_package():
    found = flip(*_pictures())
    assert found.mean() == pytest.approx(MEAN, abs=1e-5)
    for place, value in PIXELS.items():
        assert found[place] == pytest.approx(value, abs=1e-4)
    black = np.zeros((32, 32, 3))
    assert flip(black, black + 1.0).mean() == pytest.approx(WHITE_ON_BLACK, abs=1e-4)


def test_equal_pictures_do_not_differ():
    first, _ = _pictures()
    assert np.array_equal(flip(first, first), np.zeros((48, 64)))


def test_symmetric_and_within_its_range():
    first, second = _pictures()
    found = flip(first, second)
    assert np.allclose(found, flip(second, first), rtol=0.0, atol=1e-12)
    assert found.min() >= 0.0
    assert found.max() <= 1.0


def test_more_difference_is_more():
    first, _ = _pictures()
    means = [flip(first, first * part).mean() for part in (0.98, 0.9, 0.5)]
    assert 0.0 < means[0] < means[1] < means[2]


def test_what_lies_outside_is_clamped():
    first, second = _pictures()
    assert np.array_equal(flip(first * 0 + 7.0, second), flip(first * 0 + 1.0, second))


def test_a_picture_of_one_pixel():
    assert flip(np.zeros((1, 1, 3)), np.ones((1, 1, 3))).shape == (1, 1)


def test_wrong_pictures():
    first, second = _pictures()
    with pytest.raises(ValueError, match="give two of one size"):
        flip(first, second[1:])
    with pytest.raises(ValueError, match="give two of one size"):
        flip(first[..., 0], second[..., 0])
    with pytest.raises(ValueError, match="not numbers"):
        flip(first, np.full_like(second, np.inf))
