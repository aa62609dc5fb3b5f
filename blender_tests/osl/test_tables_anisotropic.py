# SPDX-License-Identifier: GPL-3.0-or-later
"""The polynomials of anisotropic metal, at surfaces and views that they were not fitted to: what
the shader makes of them, against the oracle."""

import re

import numpy as np
import pytest

from osl.oracle import lobe
from osl.oracle.surface import BECKMANN, GGX
from osl.tables import anisotropic
from osl.tables.__main__ import path
from osl.tables.anisotropic_views import (
    RESOLVED,
    View,
    exits,
    first,
    further,
    missing_energy,
    sampled,
    views,
)
from osl.tables.fitting import BOUNCES

from .probe import evaluate
from .samples import SURFACE, widths

UNSEEN = 77  # seed of the views
COUNT = len(anisotropic.POLYNOMIALS)
by_distribution = pytest.mark.parametrize("distribution", [GGX, BECKMANN])


def _chosen(distribution: str, count: int) -> list[View]:
    """Views whose light the generator's rule finds."""
    found = []
    for view in views(distribution, count, UNSEEN):
        rule = exits(view)
        if abs(rule.energy(first(view, rule.o)) + missing_energy(view) - 1.0) < RESOLVED:
            found.append(view)
    return found


def _columns(chosen: list[View]) -> dict[str, np.ndarray]:
    alpha = np.array([widths(view.surface) for view in chosen])
    return {"alpha": alpha, "wi": np.array([view.wi for view in chosen])}


def _values(chosen: list[View]) -> np.ndarray:
    """The shader's values (views, COUNT)."""
    shape = f"{SURFACE} float values[{COUNT}]; anisotropic_shape(surface, wi, values);"
    parts = [
        evaluate(
            "fitted_anisotropic.h",
            f"{shape} result = vector(values[{i}], values[{i + 1}], values[{i + 2}]);",
            **_columns(chosen),
        )
        for i in range(0, COUNT, 3)
    ]
    return np.concatenate(parts, axis=1).astype(float)


def test_coefficients_are_finite_and_complete() -> None:
    """As many of each polynomial as it has terms, of both distributions; zeros fill vectors up."""
    text = " ".join(path("anisotropic").read_text(encoding="utf-8").split())
    found = re.findall(r"values\[(\d+)\] = clamp\((.*?), [-.\de]+, [-.\de]+\);", text)
    assert [int(index) for index, _ in found] == 2 * list(range(COUNT))
    for index, sum_of_terms in found:
        vectors = ", ".join(re.findall(r"vector\(([^()]*)\)", sum_of_terms))
        numbers = np.array([float(number) for number in vectors.split(", ")])
        assert np.isfinite(numbers).all()
        assert np.count_nonzero(numbers) == len(anisotropic.POLYNOMIALS[int(index)].exponents)


@by_distribution
def test_energy(distribution: str, report) -> None:
    """The closures have all the energy of further bounces: within 0.003 as a root mean square."""
    chosen = _chosen(distribution, 256)
    values = _values(chosen)
    errors = []
    for view, one in zip(chosen, values, strict=True):
        rule = exits(view)
        kept = one[0] * (anisotropic.columns(view, rule.o, one[1:11]) @ one[1:5])
        errors.append(rule.energy(kept) - missing_energy(view))
    errors = np.abs(errors)
    found = f"rms {np.sqrt(np.mean(errors**2)):.4f}, max {errors.max():.4f}"
    report(f"anisotropic energy, {distribution}", found, "rms 0.003, max 0.015")
    assert np.sqrt(np.mean(errors**2)) < 0.003
    assert errors.max() < 0.015


@by_distribution
def test_shapes_and_colours(distribution: str, report) -> None:
    """Image L2 over the hemisphere, relative to all bounces; and the energy that a Fresnel factor
    of 1/2 leaves of bounce 2 and of later ones."""
    chosen = _chosen(distribution, 32)
    values = _values(chosen)
    errors, colours = [], []
    for seed, (view, one) in enumerate(zip(chosen, values, strict=True)):
        sample, rule = sampled(view, UNSEEN + seed), exits(view)
        kept = one[0] * (anisotropic.columns(view, rule.o, one[1:11]) @ one[1:5])
        errors.append(np.sqrt(rule.energy((kept - sample.value) ** 2)) / sample.norm)
        colours.append(sample.energy * np.abs(one[11:] - sample.colour).max())
    found = f"mean {np.mean(errors):.1%}, max {np.max(errors):.1%}"
    report(f"anisotropic shapes, {distribution}", found, "mean 2.5%, max 6%")
    report(f"anisotropic colours, {distribution}", f"{np.max(colours):.3f} of the light", "0.04")
    assert np.mean(errors) < 0.025
    assert np.max(errors) < 0.06
    assert np.max(colours) < 0.04


@by_distribution
def test_walks_are_the_oracles(distribution: str) -> None:
    """The generator's own connections, which are faster."""
    view = views(distribution, 4, UNSEEN)[1]
    o = exits(view).o[::97]
    wanted = lobe(view.wi, o, view.surface, BOUNCES, 2000, 1).mean[1:, :, 0].sum(axis=0)
    found, _ = further(view, o, 1, 2000)
    assert np.abs(found / wanted - 1.0).max() < 1e-9


@by_distribution
def test_bound_holds_for_anisotropic_surfaces(distribution: str) -> None:
    """No energy is cut off where it is faint."""
    chosen = views(distribution, 512, UNSEEN)
    bound = evaluate(
        "smith.h", f"{SURFACE} result = missing_energy_bound(surface, wi);", **_columns(chosen)
    )[:, 0]
    assert (np.array([missing_energy(view) for view in chosen]) <= bound + 1e-6).all()
