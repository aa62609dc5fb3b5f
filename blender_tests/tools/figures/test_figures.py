# SPDX-License-Identifier: GPL-3.0-or-later
"""The command makes all files, the same ones each time, and names what is wrong."""

import csv
from xml.etree import ElementTree

import numpy as np
import pytest

from tools.figures.__main__ import main
from tools.figures.cases import NUMBERS
from tools.figures.lobes import BOUNCES, PLANE_WIDTH


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    """A quick run: the folder of its files and that of its cache."""
    folder = tmp_path_factory.mktemp("figures")
    assert main(["--quick", "--jobs", "1", *where(folder / "docs", folder)]) == 0
    return folder / "docs", folder


def where(output, folder):
    return ["--output", str(output), "--cache", str(folder / "cache")]


def test_a_quick_run_makes_all_files(quick):
    made, _ = quick
    expected = {"README.md", "ggx_energies.csv", "fig02.csv", "fig17.csv"}
    expected |= {"estimators.csv", "estimators_settled.csv"}
    expected |= {f"distances_to_{one}.csv" for one in ("simulated", "height_tracked")}
    expected |= {f"fig{number:02}.svg" for number in NUMBERS}
    expected |= {f"fig{n:02}_{kind}.csv" for n in range(5, 17) for kind in ("energies", "lobes")}
    assert {file.name for file in made.iterdir()} == expected
    for file in made.glob("*.svg"):
        ElementTree.parse(file)
    for file in made.glob("*.csv"):
        rows = list(csv.reader(file.open(encoding="utf-8")))
        assert len(rows) > 1
        assert len({len(row) for row in rows}) == 1, f"{file.name} has rows of different lengths"
    assert "nan" not in (made / "README.md").read_text(encoding="utf-8")


def test_some_figures_again_are_the_same_byte_for_byte(quick):
    made, folder = quick
    some = folder / "some"
    arguments = ["--quick", "--only", "2", "9", "17", "--jobs", "1", *where(some, folder)]
    assert main(arguments) == 0
    names = {"fig02.svg", "fig02.csv", "fig17.svg", "fig17.csv", "fig09.svg"}
    assert {file.name for file in some.iterdir()} == names | {
        "fig09_energies.csv",
        "fig09_lobes.csv",
    }
    for file in some.iterdir():
        assert file.read_bytes() == (made / file.name).read_bytes(), file.name


def test_lobes_and_energies_of_a_file_agree(quick):
    made, _ = quick
    with (made / "fig15_energies.csv").open(encoding="utf-8") as file:
        energies = list(csv.DictReader(file))
    with (made / "fig15_lobes.csv").open(encoding="utf-8") as file:
        lobes = [list(row.values()) for row in csv.DictReader(file)]
    assert len(energies) == 4 * 4 * (BOUNCES + 1)
    first = {
        (row["theta"], row["column"]): float(row["E_r"]) + float(row["E_t"])
        for row in energies
        if row["bounce"] == "1"
    }
    found = {
        (theta, column): np.array(density, float).sum() * PLANE_WIDTH
        for theta, column, bounce, *density in lobes
        if bounce == "1"
    }
    # the densities have four decimals
    assert found == pytest.approx(first, abs=1e-4 * np.pi)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--quick"], "--quick must not replace the figures; name a folder with --output"),
        (["--jobs", "0"], "--jobs is 0; give 1 or more"),
        (["--only", "3"], "invalid choice: 3"),
    ],
)
def test_wrong_arguments_are_named(arguments, message, capsys):
    with pytest.raises(SystemExit):
        main(arguments)
    assert message in capsys.readouterr().err
