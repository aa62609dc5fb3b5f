# SPDX-License-Identifier: GPL-3.0-or-later
"""Projected area and the chance to leave (smith.h) against the oracle, on the whole sphere."""

import numpy as np
import pytest

from osl.oracle.masking import exit_probability
from osl.oracle.ndf import sigma
from osl.oracle.surface import BECKMANN, Surface
from osl.oracle.vectors import direction
from osl.oracle.walk import bounces

from .probe import evaluate
from .samples import DISTRIBUTIONS, SURFACE, Rows, above, all_surfaces, directions, relative_error

LARGEST_ERROR = 1e-4
# Below this an area no longer counts: single precision ends at 1e-38, and the shader's cut of
# Beckmann's tail lies at 1e-36.
SMALLEST_AREA = 1e-30


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_projected_area(distribution: str) -> None:
    rows = all_surfaces(distribution, block=500)
    w = directions(rows.count, np.random.default_rng(1))
    found = evaluate(
        "smith.h",
        f"{SURFACE} Incidence arrival = incidence(surface, w);"
        "result = vector(arrival.area, arrival.excess, 0);",
        alpha=rows.alpha,
        w=w,
    )
    assert relative_error(found[:, 0], rows.oracle(sigma, w), SMALLEST_AREA) < LARGEST_ERROR
    below = rows.oracle(sigma, -above(w))
    assert relative_error(found[:, 1], below, SMALLEST_AREA) < LARGEST_ERROR


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_exit_probability(distribution: str) -> None:
    rows = all_surfaces(distribution, block=500)
    rng = np.random.default_rng(2)
    v, o = directions(rows.count, rng), directions(rows.count, rng)
    # The factors of the odds must themselves be representable.
    odds = rows.oracle(sigma, v) * np.abs(o[:, 2]), rows.oracle(sigma, -o) * np.abs(v[:, 2])
    representable = np.maximum(*odds) > SMALLEST_AREA
    found = evaluate(
        "smith.h",
        f"{SURFACE} result = exit_probability(surface, incidence(surface, view), o);",
        alpha=rows.alpha,
        view=v,
        o=o,
    )[:, 0]
    wanted = rows.oracle(exit_probability, v, o)
    assert np.all((found >= 0.0) & (found <= 1.0))
    assert np.all(found[o[:, 2] <= 0.0] == 0.0)
    assert representable.mean() > 0.5
    floor = 1e-6  # a chance below one in a million changes nothing
    error = relative_error(found[representable], wanted[representable], floor)
    assert error < LARGEST_ERROR


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("alpha", [0.0, 1e-4, 1.0])
def test_extremes_are_finite(distribution: str, alpha: float) -> None:
    edge = np.array([0.0, 1e-30, 1e-12, 1e-6, 0.5, 1.0])
    z = np.concatenate([edge, -edge])
    w = np.stack([np.sqrt(1.0 - z * z), np.zeros_like(z), z], axis=-1).astype(np.float32)
    v, o = (np.repeat(w, len(w), axis=0), np.tile(w, (len(w), 1)))
    widths = np.tile(np.float32([alpha, alpha, distribution == BECKMANN]), (len(v), 1))
    found = evaluate(
        "smith.h",
        f"{SURFACE} Incidence arrival = incidence(surface, view);"
        "result = vector(arrival.area, exit_probability(surface, arrival, o), arrival.excess);",
        alpha=widths,
        view=v,
        o=o,
    )
    assert np.all(np.isfinite(found))
    assert np.all(found >= 0.0)
    assert np.all(found[:, 1] <= 1.0)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_missing_energy_bound(distribution: str) -> None:
    """The bound is never below the energy that stays after the first bounce (within 4 standard
    errors), so that no walk is left out which the tolerance asks for. Where it decides, between
    1e-4 and 0.05, it is mostly within a factor of 10, so that few walks are made in vain."""
    theta = np.array([0.0, 0.3, 0.6, 0.8, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5])
    widths = [(a, a) for a in (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)] + [(1.0, 0.1)]
    surfaces = tuple(Surface(*both, distribution) for both in widths)
    rows = Rows(surfaces, len(theta))
    wi = direction(theta)
    bound = evaluate(
        "smith.h",
        f"{SURFACE} result = missing_energy_bound(surface, wi);",
        alpha=rows.alpha,
        wi=np.tile(wi, (len(widths), 1)),
    )[:, 0]
    stays = np.array([_staying(surface, w) for surface in surfaces for w in wi])
    assert np.all(bound >= stays[:, 0] - 4.0 * stays[:, 1])
    decides = (bound > 1e-4) & (bound < 0.05)
    assert decides.sum() > 5
    assert np.median(bound[decides] / stays[decides, 0]) < 10.0


def _staying(surface: Surface, wi: np.ndarray, walks: int = 20_000) -> tuple[float, float]:
    """Energy that a white surface keeps after the first bounce, and its standard error."""
    first = next(bounces(np.tile(wi, (walks, 1)), surface, 1, np.random.default_rng(3)))
    return first.staying.mean(), first.staying.std() / np.sqrt(walks)


def test_ggx_area_at_the_horizon_is_half_alpha() -> None:
    """In closed form: sigma of a horizontal direction is alpha / 2 for GGX."""
    w = np.float32([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    alpha = np.float32([[0.3, 0.7, 0.0], [0.3, 0.7, 0.0]])
    statements = f"{SURFACE} Incidence arrival = incidence(surface, w); result = arrival.area;"
    found = evaluate("smith.h", statements, alpha=alpha, w=w)[:, 0]
    np.testing.assert_allclose(found, [0.15, 0.35], rtol=1e-6)
