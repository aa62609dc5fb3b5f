# SPDX-License-Identifier: GPL-3.0-or-later
"""The conductor's reflectance (fresnel.h) against the oracle."""

import numpy as np

from osl.oracle.fresnel import F82Tint, IndexOfRefraction

from .probe import evaluate
from .samples import relative_error

# A reflectance near 0 is a difference of larger numbers: below 1 % it is held to 1e-6 of the light.
FLOOR = 1e-2


def cosines(count: int, rng: np.random.Generator) -> np.ndarray:
    """Cosines (count,) of which half crowd towards grazing incidence."""
    values = np.where(np.arange(count) % 2, rng.random(count), 10 ** rng.uniform(-7, 0, count))
    values[:2] = 0.0, 1.0
    return values.astype(np.float32)


def test_f82_tint() -> None:
    rng = np.random.default_rng(7)
    f0, tint = rng.random((2, 4000, 3)).astype(np.float32)
    f0[:4], tint[:4] = ([0.0] * 3, [1.0] * 3) * 2, ([1.0] * 3, [0.0] * 3) * 2
    cosine = cosines(len(f0), rng)
    found = evaluate(
        "fresnel.h",
        "result = vector(f82_tint_fresnel(color(f0), color(tint), cosine));",
        f0=f0,
        tint=tint,
        cosine=cosine,
    )
    wanted = np.array(
        [
            F82Tint(tuple(a), tuple(b))(np.float64(c))
            for a, b, c in zip(f0, tint, cosine, strict=True)
        ]
    )
    assert relative_error(found, wanted.reshape(-1, 3), FLOOR) < 1e-4


def test_n_and_k() -> None:
    """n and k from 0 to 100, among them none at all, a mirror (n = 0) and a dielectric (k = 0)."""
    rng = np.random.default_rng(8)
    n, k = 10.0 ** rng.uniform(-3.0, 2.0, (2, 4000, 3))
    n[:500, 0], k[500:1000, 0], n[1000:1500] = 0.0, 0.0, 1.0
    n, k = n.astype(np.float32), k.astype(np.float32)
    cosine = cosines(len(n), rng)
    found = evaluate(
        "fresnel.h",
        "result = vector(n_k_fresnel(color(n), color(k), cosine));",
        n=n,
        k=k,
        cosine=cosine,
    )
    wanted = np.array(
        [
            IndexOfRefraction(tuple(a), tuple(b))(np.float64(c))
            for a, b, c in zip(n, k, cosine, strict=True)
        ]
    ).reshape(-1, 3)
    assert np.all((found >= 0.0) & (found <= 1.0))
    assert relative_error(found, wanted, FLOOR) < 1e-4


def test_nothing_reflects_where_the_index_is_one() -> None:
    cosine = np.linspace(0.1, 1.0, 10)
    found = evaluate(
        "fresnel.h", "result = vector(n_k_fresnel(color(1), color(0), cosine));", cosine=cosine
    )
    assert np.max(np.abs(found)) < 1e-6
