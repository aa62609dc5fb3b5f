# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of glass: made by their generator, and as accurate between nodes as Fitted needs."""

import re

import numpy as np
import pytest

from osl.oracle.materials import Dielectric
from osl.oracle.surface import BECKMANN, GGX, Surface
from osl.tables import dielectric, grid
from osl.tables.__main__ import path
from osl.tables.dielectric_energy import missing_energy

from .probe import evaluate

by_distribution = pytest.mark.parametrize("distribution", [GGX, BECKMANN])
by_side = pytest.mark.parametrize("inside", [False, True], ids=["outside", "inside"])


def _shapes() -> np.ndarray:
    """(inside and distribution, indices, alphas, cosines, values)."""
    text = path("dielectric").read_text(encoding="utf-8")
    found = re.search(r"void dielectric_shape.*?= \{([^}]*)\}", text, re.DOTALL)
    values = np.array([float(value) for value in found.group(1).split(",")])
    return values.reshape(4, *dielectric.SHAPES, dielectric.VALUES)


@by_side
@by_distribution
def test_nodes_are_rebuilt(distribution: str, inside: bool) -> None:
    """To the digits that are stored; libraries of other versions may round otherwise."""
    count, alphas, cosines = dielectric.SHAPES
    for index, row, column in ((1, 2, 3), (2, 5, 2)):
        alpha = grid.alphas(alphas)[row]
        eta = dielectric.indices(count, inside)[index]
        surface = Surface(alpha, alpha, distribution, Dielectric(eta))
        values, _ = dielectric.node(surface, grid.cosines(alpha, cosines)[column])
        stored = _shapes()[2 * inside + (distribution == BECKMANN), index, row, column]
        assert np.abs(stored - values).max() < 2e-3 * np.abs(values).max()


@by_side
@by_distribution
def test_energy_between_nodes(distribution: str, inside: bool, report) -> None:
    """What Cycles' glass leaves, and what the first bounce leaves, by the shader's interpolation.

    Between the last nodes before the horizon, cosines below 0.12, it is off by up to 0.12, and by
    0.03 near the critical angle: single places, of which the furnaces hold the mean.
    """
    rng = np.random.default_rng(1)
    alpha = rng.uniform(0.05, 1.0, 150).astype(np.float32)
    cosine = rng.uniform(0.12, 1.0, 150).astype(np.float32)
    index = rng.uniform(1.1, 2.5, 150)
    ior = (1.0 / index if inside else index).astype(np.float32)
    side = "inside" if inside else "outside"
    found = evaluate(
        "fitted_dielectric.h",
        f"float e[2]; dielectric_energy_{side}({int(distribution == BECKMANN)}, Alpha, Cosine, "
        "Index, e); result = vector(e[0] * e[0], e[1] * e[1], 0);",
        Alpha=alpha,
        Cosine=cosine,
        Index=ior,
    )[:, :2]
    wanted = [
        missing_energy(Surface(float(a), float(a), distribution, Dielectric(float(i))), c)
        for a, c, i in zip(alpha, cosine, ior, strict=True)
    ]
    error = np.abs(found - wanted).max(axis=1)
    value = f"nine in ten {np.quantile(error, 0.9):.4f}, largest {error.max():.4f}"
    report(f"glass, energy between nodes, {distribution}, {side}", value, "0.01, 0.05")
    assert np.quantile(error, 0.9) < 0.01
    assert error.max() < 0.05


@by_side
@by_distribution
def test_weights_keep_the_energy_between_nodes(distribution: str, inside: bool, report) -> None:
    """Each lobe's energy is interpolated beside its shape: times their part of the further bounces,
    they keep it within 4 %."""
    count = dielectric.SHAPES[0]
    table = _shapes()[2 * inside + (distribution == BECKMANN)]
    off = []
    for index in range(count - 1):
        middle = 0.5 * (table[index] + table[index + 1])
        for alpha in (0.2, 0.5, 0.85):
            for cosine in (0.2, 0.5, 0.9):
                place = np.array([alpha]), np.array([cosine])
                v = grid.interpolated(middle, *place)[0]
                wi = dielectric.view(cosine)
                back = 1.0 - v[0] ** 2 if inside else v[0] ** 2
                parts = ((1.0 - back) * v[1], back * v[5])
                for lobe, start, part in ((1, 2, parts[0]), (0, 6, parts[1])):
                    shape = dielectric.legal(wi, v[start + 1 : start + 3], lobe)
                    kind = BECKMANN if lobe else distribution
                    energy = dielectric.lobe_energy(wi, shape, kind, bool(lobe))
                    off.append(part * (v[start] ** 2 * energy - 1.0))
    value = f"{np.abs(off).max():.3f}, mean {np.mean(off):+.4f}"
    report(f"glass, lobes' energy between nodes, {distribution}, {inside}", value, "0.04")
    assert np.abs(off).max() < 0.04
