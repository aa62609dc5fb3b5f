# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference files are stored whole, and are what the oracle makes today."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest

from osl.oracle import exr, references
from osl.oracle.reference_cases import CASES

ROWS = [14, 30, 40]  # of a reference, through dim and bright parts
LIT_PIXELS = 50  # or more are compared


def test_exr_keeps_layers_and_metadata(tmp_path):
    rng = np.random.default_rng(0)
    layers = {"mean": rng.random((4, 6, 3)), "error": rng.random((4, 6, 3)), "mask": np.eye(4, 6)}
    exr.write(tmp_path / "a.exr", layers, {"alpha": "0.5 0.1", "seed": "3"})
    found, metadata = exr.read(tmp_path / "a.exr")
    assert metadata == {"alpha": "0.5 0.1", "seed": "3"}
    assert set(found) == set(layers)
    for name, picture in layers.items():
        np.testing.assert_array_equal(found[name], picture.astype(np.float32))


def test_exr_of_half_floats(tmp_path):
    layers = {"mean": 10.0 ** np.random.default_rng(1).uniform(-3.0, 1.0, (4, 6, 3))}
    exr.write(tmp_path / "a.exr", layers, {}, half=True)
    found, _ = exr.read(tmp_path / "a.exr")
    np.testing.assert_allclose(found["mean"], layers["mean"], rtol=2.0**-11)


def test_exr_errors_name_the_file(tmp_path):
    with pytest.raises(OSError, match=r"missing\.exr"):
        exr.read(tmp_path / "missing.exr")
    with pytest.raises(OSError, match="cannot write"):
        exr.write(tmp_path / "none" / "a.exr", {"mean": np.zeros((2, 2, 3))}, {})
    with pytest.raises(ValueError, match="differ in size"):
        exr.write(tmp_path / "a.exr", {"mean": np.zeros((2, 2, 3)), "mask": np.zeros((3, 2))}, {})


def test_every_case_has_its_file_and_nothing_else_is_there():
    manifest = json.loads((references.FOLDER / "manifest.json").read_text(encoding="utf-8"))
    assert list(manifest) == [case.name for case in CASES]
    files = {entry["file"] for entry in manifest.values()}
    assert {path.name for path in references.FOLDER.glob("*.exr")} == files
    for case in CASES:
        entry = manifest[case.name]
        data = (references.FOLDER / entry["file"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == entry["sha256"]
        layers, metadata = exr.read(references.FOLDER / entry["file"])
        assert metadata == case.metadata(), "the case changed; make its reference again"
        # rounding to half floats moves the error in the file
        assert references.relative_error(layers) <= case.limit * (1.001 if case.half else 1.0)


def _rows(lit):
    """ROWS, or five rows through the middle of a highlight too narrow to light ROWS enough."""
    if lit[ROWS].sum() > LIT_PIXELS:
        return ROWS
    middle = int(np.median(np.nonzero(lit)[0]))
    return list(range(middle - 2, middle + 3))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_reference_agrees_with_a_new_rendering_of_some_rows(case):
    stored, _ = exr.read(references.FOLDER / f"{case.name}.exr")
    walks = max(2, case.walks // 8)
    again = replace(case, walks=walks, seed=1000 + case.seed)
    lit = (stored["mask"] > 0.0) & (stored["mean"].max(axis=-1) > 1e-4)
    rows = _rows(lit)
    fresh = references.render(again, rows=rows)
    lit[[row for row in range(len(lit)) if row not in rows]] = False
    assert lit.sum() > LIT_PIXELS
    if "single" in stored and case.surface.material.smooth:
        # what rounding leaves in the file; half floats have steps of 6e-8 at least
        rounding = {"rtol": 2.0**-11, "atol": 3e-8} if case.half else {"rtol": 1e-6}
        np.testing.assert_allclose(stored["single"][lit], fresh["single"][lit], **rounding)
    difference = stored["mean"][lit] - fresh["mean"][lit]
    # errors are pooled before dividing: walks are skewed, so that a pixel with too low a mean has
    # too low an error as well, and single z-values lean to one side
    variance = stored["error"][lit] ** 2 + fresh["error"][lit] ** 2
    if case.half:  # rounding is uniform over a step; where hardly a walk goes on it is all there is
        variance += np.spacing(stored["mean"][lit].astype(np.float16)).astype(float) ** 2 / 12.0
    assert np.abs(difference.sum(axis=0) / np.sqrt(variance.sum(axis=0))).max() < 4.0
    # 57 pixels or more know their spread to 4 * sqrt(2 / 57) = 75 % at 4 standard errors
    spread = (difference**2).sum(axis=0) / variance.sum(axis=0)
    assert spread.min() > 0.25
    assert spread.max() < 1.75


def test_making_a_file_twice_gives_the_same_bytes(tmp_path):
    for folder in ("a", "b"):
        arguments = ["--quick", "--case", "sun_white_beckmann_0.25", "--output"]
        assert references.main([*arguments, str(tmp_path / folder)]) == 0
    name = "sun_white_beckmann_0.25.exr"
    assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_quick_pictures_never_replace_the_references(capsys):
    with pytest.raises(SystemExit):
        references.main(["--quick"])
    assert "--output" in capsys.readouterr().err
