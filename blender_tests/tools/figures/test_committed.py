# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures in ``docs/figures`` are complete, and their numbers are what the oracle says today.

Fresh estimates come from the oracle's own `energies`, `simulated_energies` and `evaluate`, not from
the code that made the files. They are held within 4 standard errors of both together.
"""

import csv
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from osl.oracle import Surface, energies, evaluate
from osl.oracle.height_field import HeightField
from osl.oracle.masking import G1
from osl.oracle.ray_tracer import Tracer
from osl.oracle.simulation import simulated_energies
from osl.oracle.surface import BECKMANN, GGX
from osl.oracle.vectors import direction
from tools.figures.__main__ import FOLDER
from tools.figures.cases import (
    COLUMNS,
    LOBE_FIGURES,
    MATERIALS,
    MODELS,
    NUMBERS,
    SIMULATED,
    THETAS,
    name,
)
from tools.figures.lobes import incident

FIGURES = {figure.number: figure for figure in LOBE_FIGURES}
KILOBYTE = 1024


def rows(file):
    """The rows of a CSV file, by the names of its columns."""
    with (FOLDER / file).open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def panel(number, column, theta):
    """Energies ``(bounces, 2)`` of a panel, the last row all bounces, and their errors."""
    mine = [
        row
        for row in rows(f"{name(number)}_energies.csv")
        if row["column"] == column and float(row["theta"]) == theta
    ]
    mean, error = (
        np.array([[float(row[f"E_{side}{suffix}"]) for side in "rt"] for row in mine])
        for suffix in ("", "_error")
    )
    return mean, error


@pytest.mark.parametrize("number", NUMBERS)
def test_a_figure_is_there_whole_and_small(number):
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    picture = FOLDER / f"{name(number)}.svg"
    assert ElementTree.parse(picture).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    assert picture.stat().st_size < 150 * KILOBYTE
    kinds = ["_energies", "_lobes"] if number in FIGURES else [""]
    tables = [f"{name(number)}{kind}.csv" for kind in kinds]
    assert all((FOLDER / table).stat().st_size < 100 * KILOBYTE for table in tables)
    assert f"]({picture.name})" in page
    assert all(f"]({table})" in page for table in tables)


def test_the_page_has_no_dead_links_and_nothing_lies_about():
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\]\(([^)#]+)\)", page))
    assert linked | {"README.md"} == {file.name for file in FOLDER.iterdir()}


@pytest.mark.parametrize("number", FIGURES)
def test_all_light_leaves(number):
    for column in COLUMNS:
        for theta in THETAS:
            mean, error = panel(number, column, theta)
            total = mean[-1].sum()
            assert mean[:-1].sum() == pytest.approx(total, abs=2e-5)  # six decimals
            # E_r and E_t of a panel make up for each other, so that their sum errs less than
            # either; 1e-6 is the last decimal, 1e-4 the share of rays that may get lost
            slack = 4.0 * error[-1].max() + (1e-4 if column == SIMULATED else 1e-6)
            assert abs(total - 1.0) < slack


@pytest.mark.parametrize(
    ("number", "model", "theta"),
    [
        (5, "correlated", 1.5),
        (7, "height-tracked", 0.0),
        (8, "uncorrelated", 1.0),
        (9, "uncorrelated", 1.5),
        (10, "correlated", 0.5),
        (11, "height-tracked", 1.0),
        (12, "correlated", 1.5),
        (13, "height-tracked", 1.5),
        (15, "uncorrelated", 1.5),
        (15, "correlated", 0.0),
        (16, "correlated", 1.5),
    ],
)
def test_models_are_as_the_oracle_finds_them(number, model, theta):
    figure = FIGURES[number]
    surface = Surface(*figure.alpha, BECKMANN, MATERIALS[figure.material], MODELS[model])
    found = energies(incident(theta), surface, 4, 20_000, number)
    mean, error = panel(number, model, theta)
    for side, fresh in enumerate((found.reflected, found.transmitted)):
        if side == 1 and not figure.transmits:
            np.testing.assert_array_equal(mean[:, 1], 0.0)
            continue
        hit = mean[:4, side] > 1e-3  # fainter bounces are too few walks for a normal distribution
        apart = fresh.mean[:, 0] - mean[:4, side]
        bound = 4.0 * np.hypot(fresh.standard_error[:, 0], error[:4, side])
        assert np.all(np.abs(apart[hit]) < bound[hit])


@pytest.mark.nightly
@pytest.mark.parametrize(("number", "theta"), [(6, 1.0), (11, 0.0), (12, 0.5), (15, 1.0)])
def test_the_simulated_surface_is_as_other_sheets_find_it(number, theta):
    figure = FIGURES[number]
    surface = Surface(*figure.alpha, BECKMANN)
    sheets = (Tracer(HeightField.gaussian(surface, 256, 8.0, seed)) for seed in range(500, 512))
    wi, material = incident(theta), MATERIALS[figure.material]
    found = simulated_energies(sheets, wi, material, 3, 4_000, number)
    mean, error = panel(number, SIMULATED, theta)
    side = int(figure.transmits)
    fresh = (found.reflected, found.transmitted)[side]
    apart = fresh.mean[:, 0] - mean[:3, side]
    # 12 sheets: Student's distribution of 11 degrees passes 5.9 as often as a normal one passes 4
    bound = np.hypot(5.9 * fresh.standard_error[:, 0], 4.0 * error[:3, side])
    assert np.all(np.abs(apart) < bound)


def test_far_pairs_of_the_two_estimators_are_settled():
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    far = rows("estimators_settled.csv")
    assert f"and by more than 4 in {len(far)} of" in " ".join(page.split())
    for row in far:
        walk, other = float(row["walk"]), float(row["bidirectional"])
        error = np.hypot(float(row["walk_error"]), float(row["bidirectional_error"]))
        assert abs(float(row["z"])) > 4.0
        assert abs(walk - other) < 4.0 * error
        assert float(row["z_settled"]) == pytest.approx((walk - other) / error, abs=0.02)


def test_masking_is_as_the_oracle_finds_it():
    for row in rows("fig02.csv")[::37]:
        surface = Surface(float(row["alpha"]), float(row["alpha"]), row["distribution"])
        w = direction(float(row["theta"]))
        if row["formula"] != "inf":
            assert float(row["formula"]) == pytest.approx(float(G1(w, surface)), rel=1e-9)
            assert float(row["integral"]) == pytest.approx(float(row["formula"]), rel=1e-9)


@pytest.mark.parametrize("model", ["uncorrelated", "correlated"])
def test_reciprocity_is_as_the_oracle_finds_it(model):
    pairs = rows("fig17.csv")
    difference, error = (np.array([float(row[model + s]) for row in pairs]) for s in ("", "_error"))
    mean = difference.mean()
    scatter = difference.std(ddof=1) / np.sqrt(len(pairs))
    z = difference / error
    if model == "uncorrelated":
        # centred on zero, and no wider than noise: the variance of n unit normals scatters by
        # sqrt(2/n)
        assert abs(mean) < 4.0 * scatter
        assert abs(np.mean(z * z) - 1.0) < 4.0 * np.sqrt(2.0 / len(pairs))
    else:
        assert abs(mean) > 10.0 * scatter
        assert np.abs(z).max() > 10.0
    some = pairs[:4]
    wi, wo = (
        np.array([direction(float(row[f"theta_{w}"]), float(row[f"phi_{w}"])) for row in some])
        for w in "io"
    )
    surface = Surface(1.0, 1.0, GGX, MATERIALS["conductor"], MODELS[model])
    there, back = (evaluate(*both, surface, 64, 20_000, 3) for both in ((wi, wo), (wo, wi)))
    fresh = there.total[:, 0] / wo[:, 2] - back.total[:, 0] / wi[:, 2]
    variance = (
        there.total_variance[:, 0] / wo[:, 2] ** 2 + back.total_variance[:, 0] / wi[:, 2] ** 2
    )
    # both estimates see the same first bounce; angles of four decimals shift it by less than noise
    assert np.all(np.abs(fresh - difference[:4]) < 4.0 * np.sqrt(variance + error[:4] ** 2))
