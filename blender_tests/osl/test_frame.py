# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames (frame.h) and the reading of inputs (inputs.h)."""

import numpy as np
import pytest

from .probe import evaluate
from .samples import directions

FRAME = "Frame frame = shading_frame(n, along);"


def test_frame_is_cycles_convention() -> None:
    """y = N x T, x = y x N, normalised; also for tangents within 1e-3 of the normal."""
    rng = np.random.default_rng(13)
    n = directions(3000, rng)
    tangent = directions(3000, rng)
    close = n[:1000] + rng.normal(size=(1000, 3)) * 10.0 ** rng.uniform(-3.0, 0.0, (1000, 1))
    tangent[:1000] = (close / np.linalg.norm(close, axis=-1, keepdims=True)).astype(np.float32)
    y = np.cross(n.astype(float), tangent.astype(float))
    length = np.linalg.norm(y, axis=-1, keepdims=True)
    y /= length
    found = [
        evaluate("frame.h", f"{FRAME} result = frame.{axis};", n=n, along=tangent) for axis in "xyz"
    ]
    wanted = np.cross(y, n), y, n
    # The direction of the cross product is as uncertain as float32 products over its length.
    defined = length[:, 0] > 1e-4  # the others, both near one pole, may take any tangent
    assert defined.sum() > 2000
    for axis, value in zip(found, wanted, strict=True):
        assert np.max((np.abs(axis - value) * length)[defined]) < 1e-6


@pytest.mark.parametrize("kind", ["parallel", "opposite", "equal to rounding"])
def test_frame_without_a_usable_tangent_is_orthonormal(kind: str) -> None:
    n = directions(3000, np.random.default_rng(14))
    tangent = {"parallel": n, "opposite": -n, "equal to rounding": n * np.float32(1 + 1e-7)}[kind]
    axes = [
        evaluate("frame.h", f"{FRAME} result = frame.{axis};", n=n, along=tangent).astype(float)
        for axis in "xyz"
    ]
    gram = np.einsum("inc,jnc->nij", axes, axes)
    assert np.max(np.abs(gram - np.eye(3))) < 1e-5


def test_local_and_back() -> None:
    rng = np.random.default_rng(15)
    n, tangent, w = (directions(2000, rng) for _ in range(3))
    found = evaluate(
        "frame.h",
        f"{FRAME} result = to_world(frame, to_local(frame, w));",
        n=n,
        along=tangent,
        w=w,
    )
    usable = np.linalg.norm(np.cross(n, tangent), axis=-1) > 1e-3
    assert np.max(np.abs(found - w)[usable]) < 1e-5


def test_normals_turned_away_are_bent_into_view() -> None:
    """Unchanged where the viewer sees them; else unit, just in view, and in the plane of both."""
    rng = np.random.default_rng(16)
    n, view = directions(3000, rng), directions(3000, rng)
    n[0] = -view[0]
    found = evaluate("frame.h", "result = visible_normal(n, view);", n=n, view=view).astype(float)
    cosine = np.sum(n.astype(float) * view, axis=-1)
    seen = cosine > 1.1e-4
    np.testing.assert_allclose(found[seen], n[seen], atol=1e-6)
    assert np.max(np.abs(np.linalg.norm(found, axis=-1) - 1.0)) < 1e-5
    bent = np.sum(found * view, axis=-1)
    assert np.all(bent > 5e-5)
    ordinary = (cosine < 0.0) & (cosine > -0.9)
    assert np.max(np.abs(bent[ordinary])) < 1e-3


def test_legal_values() -> None:
    found = evaluate(
        "inputs.h",
        "result = vector(legal(x, 0, 1, 0.5), 0, legal(x, -2, 2, 0));",
        x=np.array([-1.0, 0.25, 3.0, np.nan, np.inf, -np.inf]),
    )
    np.testing.assert_allclose(found[:, 0], [0.0, 0.25, 1.0, 0.5, 0.5, 0.5])
    np.testing.assert_allclose(found[:3, 2], [-1.0, 0.25, 2.0])


def test_directions_without_a_direction() -> None:
    values = np.array([[0, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0], [0, 3, 4], [1e-30, 0, 0]])
    found = evaluate("inputs.h", "result = direction(value, vector(0, 0, 1));", value=values)
    np.testing.assert_allclose(found[[0, 1, 2, 4]], np.tile([0.0, 0.0, 1.0], (4, 1)))
    np.testing.assert_allclose(found[3], [0.0, 0.6, 0.8], rtol=1e-6)
