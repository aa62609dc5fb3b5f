# SPDX-License-Identifier: GPL-3.0-or-later
"""Reflectances (fresnel.h) and their means (fitted.h) against the oracle."""

import numpy as np

from osl.oracle.fresnel import F82Tint, IndexOfRefraction, dielectric_reflectance

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


def test_dielectric() -> None:
    """Indices from both sides, nearly 1 and far from it, against Fresnel's formulas."""
    rng = np.random.default_rng(9)
    eta = 10.0 ** rng.uniform(-1.0, 1.0, 4000)
    eta[:1000] = 1.0 + rng.uniform(-1e-3, 1e-3, 1000)
    eta = eta.astype(np.float32)
    cosine = cosines(len(eta), rng)
    found = evaluate(
        "fresnel.h", "result = vector(dielectric_fresnel(eta, cosine));", eta=eta, cosine=cosine
    )
    wanted = dielectric_reflectance(cosine.astype(np.float64), eta.astype(np.float64))
    # Next to the critical angle it goes with the root of the angle: rounding of 6e-8 shows as 2e-4.
    assert relative_error(found[:, 0], wanted, FLOOR) < 1e-3


def test_mean_fresnel_of_schlicks_curve_is_its_value() -> None:
    """That is how the tables' cosines are defined (osl/tables/conductor.py)."""
    rng = np.random.default_rng(10)
    f0 = rng.random((500, 3)).astype(np.float32)
    cosine = rng.uniform(0.2, 1.0, 500).astype(np.float32)
    found = evaluate(
        "fitted.h",
        "Conductor metal; metal.physical = 0; metal.first = color(f0); metal.second = color(1);"
        "result = vector(mean_fresnel(fresnel_range(metal), cosine));",
        f0=f0,
        cosine=cosine,
    )
    wanted = f0 + (1.0 - f0) * (1.0 - cosine[:, None]) ** 5
    assert np.max(np.abs(found - wanted)) < 1e-4
