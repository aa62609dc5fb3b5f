# SPDX-License-Identifier: GPL-3.0-or-later
"""The bidirectional estimator's gain counts errors that nobody knows as such."""

import numpy as np
import pytest

from tools.figures.cases import QUICK, estimators, settled
from tools.figures.estimators import MAX_BOUNCES
from tools.figures.gains import FAR, Gain, totals, work, z_scores

WALKS = 101  # a relative standard error of 0.1 is a standard deviation of 1 for one walk


def found(*pairs):
    """One bounce of pairs (mean, error) by walk and bidirectional estimator."""
    mean, error = np.moveaxis(np.array(pairs, float), -1, 0)
    return {"mean": mean.T[:, None], "variance": error.T[:, None] ** 2}


BOTH = [(1.0, 0.2), (1.0, 0.1)]
BLIND = [(0.0, 0.0), (1.0, 0.1)]  # the walk finds nothing
POOR = [(1.0, 0.5), (1.0, 0.1)]
NEITHER = [(1.0, 0.9), (1.0, 0.5)]
DARK = [(0.0, 0.0), (0.0, 0.0)]


def test_medians_are_over_pairs_with_light():
    gain = Gain.of(found(BOTH, BOTH, DARK), WALKS)
    assert gain.pairs.tolist() == [2]
    assert gain.unknown.tolist() == [[0], [0]]
    np.testing.assert_allclose(gain.deviation, [[2.0], [1.0]])
    np.testing.assert_allclose(gain.ratio, [4.0])


@pytest.mark.parametrize("unknown", [BLIND, POOR])
def test_an_unknown_error_of_the_walk_is_infinite(unknown):
    gain = Gain.of(found(BOTH, BOTH, unknown), WALKS)
    assert gain.unknown.tolist() == [[1], [0]]
    np.testing.assert_allclose(gain.ratio, [4.0])
    gain = Gain.of(found(BOTH, unknown, unknown), WALKS)
    np.testing.assert_allclose(gain.deviation, [[np.inf], [1.0]])
    assert gain.ratio.tolist() == [np.inf]


def test_two_unknown_errors_have_no_ratio():
    gain = Gain.of(found(BOTH, NEITHER, NEITHER), WALKS)
    assert gain.unknown.tolist() == [[2], [2]]
    assert np.isnan(gain.ratio[0])
    gain = Gain.of(found(BOTH, BOTH, NEITHER), WALKS)
    np.testing.assert_allclose(gain.ratio, [4.0])
    gain = Gain.of(found(DARK), WALKS)
    assert gain.pairs.tolist() == [0]
    assert np.isnan(gain.ratio[0])


def test_z_is_in_standard_errors_of_both():
    np.testing.assert_allclose(z_scores(found([(1.0, 0.3), (2.0, 0.4)], DARK)), [-2.0, 0.0])


def test_work_of_two_bounces_more():
    # bounces 2 to 6: joints 2 + ... + 6, terms 4 + 9 + 16 + 25 + 36
    assert MAX_BOUNCES == 6
    assert work() == ((6, 5), (10, 20, 90))


def test_far_pairs_are_computed_again_and_no_others():
    tasks = estimators(QUICK)
    near, far = [(1.0, 0.1), (1.2, 0.1)], [(1.0, 0.1), (2.0, 0.1)]
    case, task = next((case, task) for case, task in tasks.items() if case[1] == "dielectric")
    results = dict.fromkeys(tasks.values(), found(near, near)) | {task: found(near, far)}
    again = settled(results, QUICK)
    assert list(again) == [(case, 1)]
    (one,) = again.values()
    wi, wo = one.directions()
    np.testing.assert_array_equal(wi[0], task.directions()[0][1])
    np.testing.assert_array_equal(wo[0], task.directions()[1][1])
    total, error = totals(one.run(3))
    assert total.shape == error.shape == (2, 1)
    assert np.all(total > 0.0)
    assert FAR == 4.0
