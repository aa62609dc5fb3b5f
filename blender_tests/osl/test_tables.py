# SPDX-License-Identifier: GPL-3.0-or-later
"""Generated tables: up to date, small, made by their generators, and as accurate as they say."""

import re

import numpy as np
import pytest

from osl.oracle.error_function import deficit
from osl.oracle.materials import Diffuse
from osl.oracle.surface import BECKMANN, GGX, Surface
from osl.tables import conductor, diffuse, grid
from osl.tables.__main__ import FITTED, is_stale, path
from osl.tables.special import is_stale as are_special_stale

from .probe import evaluate

LARGEST = 64 * 1024  # bytes of a shader's tables, as 32-bit floats


def _tables(name: str) -> list[np.ndarray]:
    """The values of a header's tables, each ``(n,)``."""
    found = re.findall(r"table\[(\d+)\] = \{([^}]*)\}", path(name).read_text(encoding="utf-8"))
    tables = [np.array([float(value) for value in text.split(",")]) for _, text in found]
    assert [int(size) for size, _ in found] == [table.size for table in tables]
    return tables


@pytest.mark.parametrize("name", FITTED)
def test_header_is_what_its_sources_made(name: str) -> None:
    assert not is_stale(name), "run make tables"


def test_special_functions_are_what_their_generator_writes() -> None:
    assert not are_special_stale(), "run make tables"


@pytest.mark.parametrize("name", ["conductor", "dielectric", "diffuse"])
def test_tables_are_finite_and_small(name: str) -> None:
    tables = _tables(name)
    assert tables
    assert all(np.isfinite(table).all() for table in tables)
    assert 4 * sum(table.size for table in tables) <= LARGEST


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
def test_metal_nodes_are_rebuilt(distribution: str) -> None:
    """The roughest nodes, which no others precede, seen at two angles."""
    shape, colour = (
        table.reshape(2, conductor.ALPHAS, conductor.COSINES, -1)
        for table in _tables("conductor")[:2]
    )
    table = np.concatenate([shape, colour], axis=-1)
    start = np.array(conductor.START[distribution == BECKMANN])
    for column in (4, 8):
        cosine = grid.cosines(1.0, conductor.COSINES)[column]
        values, _ = conductor.node(Surface(1.0, 1.0, distribution), cosine, start)
        _assert_same(table[int(distribution == BECKMANN), -1, column], values)


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
def test_matte_nodes_are_rebuilt(distribution: str) -> None:
    table = _tables("diffuse")[0]
    table = table.reshape(2, diffuse.ALPHAS, diffuse.COSINES, diffuse.VALUES)
    for row, column in ((4, 8), (11, 4)):
        alpha = grid.alphas(diffuse.ALPHAS)[row]
        cosine = grid.cosines(alpha, diffuse.COSINES)[column]
        values, _ = diffuse.node(Surface(alpha, alpha, distribution, Diffuse()), cosine)
        _assert_same(table[int(distribution == BECKMANN), row, column], values)


def _assert_same(stored: np.ndarray, values: np.ndarray) -> None:
    """To the digits that are stored; libraries of other versions may round otherwise."""
    assert np.abs(stored - values).max() < 2e-3 * np.abs(values).max()


@pytest.mark.parametrize("distribution", [GGX, BECKMANN])
def test_energy_between_nodes(distribution: str) -> None:
    """The table of metal's further energy, by the shader's interpolation, within 0.003."""
    rng = np.random.default_rng(1)
    alpha = rng.uniform(0.05, 1.0, 200).astype(np.float32)
    cosine = rng.uniform(0.02, 1.0, 200).astype(np.float32)
    found = evaluate(
        "../tables/conductor_lobes.h",
        f"float e[1]; conductor_energy({int(distribution == BECKMANN)}, alpha, cosine, e); "
        "result = e[0];",
        alpha=alpha,
        cosine=cosine,
    )[:, 0]
    wanted = [
        conductor.missing_energy(Surface(float(a), float(a), distribution), float(c))
        for a, c in zip(alpha, cosine, strict=True)
    ]
    assert np.abs(found - wanted).max() < 0.003


def test_ierfcx() -> None:
    x = np.concatenate([[0.0], np.geomspace(1e-6, 1e4, 4000)]).astype(np.float32)
    found = evaluate("../tables/special.h", "result = ierfcx(x);", x=x)[:, 0]
    wanted = deficit(x.astype(float))
    assert np.max(np.abs(found / wanted - 1.0)) < 1e-6
