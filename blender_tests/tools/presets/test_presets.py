# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: their colours, indices and matte albedos, and the command on small clones."""

import json
import sys

import numpy as np
import pytest

from osl.oracle.fresnel import IndexOfRefraction
from tools.presets import __main__ as command
from tools.presets.albedo import energy_by_bounce, facet_albedo, total_albedo
from tools.presets.colour import WAVELENGTHS, colour, daylight, matching_functions
from tools.presets.database import PhysicallyBased, RefractiveIndex, SourceError
from tools.presets.optics import COS_82, MOST, effective_index, metal, reflectance, transmittance

CATALOGUE = """
- SHELF: main
  name: "MAIN"
  content:
    - BOOK: Xx
      name: "Xx<sub>2</sub> (Example)"
      content:
        - DIVIDER: "Films"
        - PAGE: Gray-a
          name: "Gray et al. 2001: Film; n,k 0.3–0.9 µm"
          data: main/Xx/nk/Gray.yml
        - PAGE: Glass
          name: "Glass 2002: n 0.3–0.9 µm"
          data: main/Xx/nk/Glass.yml
        - PAGE: Short
          name: "Short 2003: n,k 0.5–0.6 µm"
          data: main/Xx/nk/Short.yml
        - PAGE: Odd
          name: "Odd 2004: n 0.3–0.9 µm"
          data: main/Xx/nk/Odd.yml
        - PAGE: Lost
          name: "Lost 2005"
          data: main/Xx/nk/Lost.yml
"""
HEADER = "REFERENCES: |\n    Data: none\nDATA:\n"
GRAY = HEADER + "  - type: tabulated nk\n    data: |\n        0.3 2.0 3.0\n        0.9 2.0 3.0\n"
SHORT = HEADER + "  - type: tabulated nk\n    data: |\n        0.5 2.0 3.0\n        0.6 2.0 3.0\n"
FORMULA = HEADER + "  - type: {}\n    wavelength_range: 0.3 0.9\n    coefficients: {}\n"
BLUE = "  - type: tabulated k\n    data: |\n        0.3 0.0\n        0.5 0.0\n        0.9 1.0e-5\n"
# SCHOTT's coefficients of N-BK7, whose n_d is 1.51680.
BK7 = "0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653"
TABLES = {
    "METALS": "Gray Metal | main/Xx/Gray-a | Film | gray, test",
    "CLEAR": "Crown | main/Xx/Glass | Clear | glass",
    "TINTED": "Blue Crown | main/Xx/Glass | Pane | glass | 2",
    "COLOURED": "Juice | Juice (Red) | Drink | liquid",
    "MATTE": "Clay | Clay | Fired | ceramic",
    "FINISHES": "Dull | C M | 0.5 | 0 | 0.25 | Beckmann | Dull",
}
MATERIALS = [
    {
        "name": name,
        "ior": 1.33,
        "roughness": 1,
        "color": [
            {"colorSpace": "acescg", "color": [9, 9, 9]},
            {"colorSpace": "srgb-linear", "color": [0.49, 0.25, 0]},
        ],
    }
    for name in ("Juice (Red)", "Clay")
]


@pytest.fixture
def clones(tmp_path):
    """Small clones of both sources: (folder, folder)."""
    data = tmp_path / "index" / "database" / "data" / "main" / "Xx" / "nk"
    data.mkdir(parents=True)
    (data.parents[3] / "catalog-nk.yml").write_text(CATALOGUE, encoding="utf-8")
    (data / "Gray.yml").write_text(GRAY, encoding="utf-8")
    (data / "Short.yml").write_text(SHORT, encoding="utf-8")
    (data / "Glass.yml").write_text(FORMULA.format("formula 2", BK7) + BLUE, encoding="utf-8")
    (data / "Odd.yml").write_text(FORMULA.format("formula 9", "1 2"), encoding="utf-8")
    version = tmp_path / "physical" / "deploy" / "v2"
    version.mkdir(parents=True)
    text = json.dumps({"data": MATERIALS})
    (version / "materials.json").write_text(text, encoding="utf-8")
    return tmp_path / "index", tmp_path / "physical"


@pytest.fixture
def run(clones, tmp_path, monkeypatch):
    """Runs the command on the clones with tables of one line; returns the exit code."""
    for name, table in TABLES.items():
        monkeypatch.setattr(command, name, table)
    monkeypatch.setattr(command, "FOLDER", tmp_path / "presets")

    def main(*options):
        arguments = [str(folder) for folder in clones]
        monkeypatch.setattr(sys, "argv", ["presets", *arguments, *options])
        return command.main()

    return main


def test_white_is_white_and_daylight_is_d65():
    xyz = (matching_functions(WAVELENGTHS) * daylight(WAVELENGTHS)).sum(axis=1)
    # CIE 15 has x = 0.31272 and y = 0.32903; the analytic functions are within 1e-3
    assert xyz[:2] / xyz.sum() == pytest.approx((0.31272, 0.32903), abs=1e-3)
    assert colour(np.ones(WAVELENGTHS.size)) == pytest.approx(np.ones(3), abs=1e-12)
    assert colour(np.full(WAVELENGTHS.size, 0.18)) == pytest.approx(np.full(3, 0.18), abs=1e-12)


def test_parts_of_the_spectrum_have_their_colour():
    red, green, blue = (
        colour((low <= WAVELENGTHS) & (high > WAVELENGTHS))
        for low, high in ((600, 781), (490, 600), (380, 490))
    )
    assert red + green + blue == pytest.approx(np.ones(3))
    for channel, part in enumerate((red, green, blue)):
        assert part.argmax() == channel
        assert part[channel] > 0.8


@pytest.mark.parametrize("cosine", [1.0, 0.6, COS_82])
def test_reflectance_is_the_oracles(cosine):
    n, k = np.array([0.2, 1.5, 4.0]), np.array([3.0, 0.0, 2.5])
    expected = IndexOfRefraction(n, k)(np.array([cosine]))[0]
    assert reflectance(n, k, cosine) == pytest.approx(expected, rel=1e-12)


def test_effective_indices_give_back_what_real_ones_reflect():
    for n, k in ((0.2, 3.2), (1.4, 1.8), (2.9, 3.0), (3.9, 0.02)):
        normal, edge = reflectance(n, k, 1.0), reflectance(n, k, COS_82)
        found = effective_index(normal, edge, 1.1 * n, 0.9 * k)
        assert reflectance(*found, 1.0) == pytest.approx(normal, abs=1e-3)
        assert reflectance(*found, COS_82) == pytest.approx(edge, abs=1e-3)
    found = effective_index(1.04, 1.0, 0.2, 3.2)
    assert reflectance(*found, 1.0) == pytest.approx(MOST, abs=2e-3)


@pytest.mark.parametrize(
    ("formula", "coefficients", "expected"),
    [
        ("formula 1", "0 0.6961663 0.0684043 0.4079426 0.1162414 0.8974794 9.896161", 1.45846),
        ("formula 2", BK7, 1.5168),
        ("formula 3", "2.25 0.01 -2", np.sqrt(2.25 + 0.01 / 0.58756**2)),
        ("formula 4", "2 0.1 2 0.1 2", np.sqrt(2 + 0.1 * 0.58756**2 / (0.58756**2 - 0.01))),
        ("formula 5", "1.5 0.004 -2", 1.5 + 0.004 / 0.58756**2),
    ],
)
def test_dispersion_formulas(clones, formula, coefficients, expected):
    folder, _ = clones
    path = folder / "database/data/main/Xx/nk/Glass.yml"
    path.write_text(FORMULA.format(formula, coefficients), encoding="utf-8")
    spectrum = RefractiveIndex(folder).spectrum("main/Xx/Glass")
    assert spectrum.n(np.array([587.56])) == pytest.approx([expected], abs=1e-5)
    assert spectrum.k is None
    with pytest.raises(SourceError, match="goes from 300 to 900 nm only"):
        spectrum.n(np.array([950.0]))


def test_a_gray_metal_is_gray_in_all_values(clones):
    spectrum = RefractiveIndex(clones[0]).spectrum("main/Xx/Gray-a")
    assert spectrum.title == "Xx2 (Example): Gray et al. 2001: Film"
    assert spectrum.url == "https://refractiveindex.info/?shelf=main&book=Xx&page=Gray-a"
    found = metal(spectrum)
    assert found.base_color == pytest.approx(np.full(3, 10 / 18))  # ((n-1)^2+k^2)/((n+1)^2+k^2)
    assert found.n == pytest.approx(np.full(3, 2.0), abs=1e-6)
    assert found.k == pytest.approx(np.full(3, 3.0), abs=1e-6)


def test_tinted_glass_takes_its_colour_from_its_thickness(clones):
    spectrum = RefractiveIndex(clones[0]).spectrum("main/Xx/Glass")
    thin, thick = transmittance(spectrum, 1e-3), transmittance(spectrum, 0.05)
    assert np.all(thin > 0.99)
    assert thick[2] > thick[1] > thick[0]
    assert thick[2] > 0.9


@pytest.mark.parametrize(
    ("page", "message"),
    [
        ("main/Xx/None", "main/Xx/None is not in the catalogue"),
        ("main/Xx/Odd", "has a formula 9, which is not known here"),
        ("main/Xx/Lost", "Lost.yml is missing"),
    ],
)
def test_pages_that_cannot_be_read_are_named(clones, page, message):
    with pytest.raises(SourceError, match=message):
        RefractiveIndex(clones[0]).spectrum(page)


def test_measurements_of_a_part_of_the_visible_range_are_refused(clones):
    with pytest.raises(SourceError, match=r"Short.yml goes from 500 to 600 nm only"):
        metal(RefractiveIndex(clones[0]).spectrum("main/Xx/Short"))


def test_what_is_no_clone_is_refused(tmp_path):
    with pytest.raises(SourceError, match=r"catalog-nk.yml is missing: give a clone"):
        RefractiveIndex(tmp_path).spectrum("main/Xx/Glass")
    with pytest.raises(SourceError, match=r"materials.json is missing: give a clone"):
        PhysicallyBased(tmp_path).material("Clay")


def test_matte_albedo_is_found_back_and_its_walks_are_enough(monkeypatch):
    totals = np.array([0.0, 0.05, 0.5, 0.95, 1.0])
    for roughness in (0.0, 0.5, 1.0):
        facets = facet_albedo(totals, roughness)
        assert total_albedo(facets, roughness) == pytest.approx(totals, abs=1e-9)
    assert facet_albedo(0.3, 0.0) == pytest.approx(0.3, abs=1e-9)
    assert facet_albedo(0.3, 1.0) > facet_albedo(0.3, 0.5) > 0.3
    first = total_albedo(np.array([0.2, 0.5, 0.8]), 0.9)
    monkeypatch.setattr("tools.presets.albedo._SEED", 2)
    energy_by_bounce.cache_clear()
    second = total_albedo(np.array([0.2, 0.5, 0.8]), 0.9)
    energy_by_bounce.cache_clear()
    assert not np.array_equal(first, second)
    assert first == pytest.approx(second, abs=1e-3)


def test_the_command_writes_and_checks(run, tmp_path, capsys):
    folder = tmp_path / "presets"
    assert run("--check") == 1
    assert not folder.exists()
    (folder / "finish").mkdir(parents=True)
    (folder / "finish" / "old.toml").write_text("", encoding="utf-8")
    assert run() == 0
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.toml"))
    assert names == [
        "conductor/gray_metal.toml",
        "dielectric/blue_crown.toml",
        "dielectric/crown.toml",
        "dielectric/juice.toml",
        "diffuse/clay.toml",
        "finish/dull.toml",
    ]
    capsys.readouterr()
    assert run("--check") == 0
    assert capsys.readouterr().out == "6 presets and finishes, 0 changed\n"
    path = folder / "conductor" / "gray_metal.toml"
    path.write_text(path.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    assert run("--check") == 1
    assert "conductor/gray_metal.toml differs\n" in capsys.readouterr().out


def test_what_the_command_writes_is_read_by_the_extension(run, tmp_path, monkeypatch):
    from addon.core.presets import catalogue as presets

    assert run() == 0
    monkeypatch.setattr(presets, "FOLDER", tmp_path / "presets")
    assert presets.problems() == ()
    assert presets.preset("dielectric/crown").values["IOR"] == 1.5168
    juice = presets.preset("dielectric/juice").values
    assert juice == {"Color": (0.7, 0.5, 0.0), "IOR": 1.33}
    assert presets.preset("conductor/gray_metal").tags == ("gray", "test")
    dull = presets.finish("finish/dull")
    assert dull.kinds == ("CONDUCTOR", "DIFFUSE")
    assert dull.values == {
        "Roughness": 0.5,
        "Anisotropy": 0.0,
        "Rotation": 0.25,
        "Distribution": 1,
    }


def test_the_command_says_what_is_missing(run, monkeypatch, capsys):
    monkeypatch.setattr(command, "MATTE", "Ash | Ashes | Gray | ground")
    assert run() == 1
    assert "No preset was made: physicallybased.info has no 'Ashes'" in capsys.readouterr().err
