# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere's geometry, its pictures, and the reference files made of them."""

import hashlib
import json

import numpy as np
import pytest

from blender_tests.oracle import Surface, exr, first_bounce, references, sphere
from blender_tests.oracle.surface import BECKMANN

ROWS = [14, 30, 47]  # of a reference, through dim and bright parts


def test_points_lie_on_the_sphere_behind_their_pixels():
    points, mask = sphere.sphere_points(16, 4)
    assert points.shape == (16, 16, 16, 3)
    np.testing.assert_allclose(np.linalg.norm(points, axis=-1), 1.0, rtol=1e-14)
    assert np.all(points[..., 1] < 0.0)  # the half that faces the camera
    # pixel (row 4, column 10) covers x from 2/16 to 3/16 and z from 3/16 to 4/16 of the width
    here = points[4, 10] / sphere.CAMERA_WIDTH
    assert mask[4, 10]
    np.testing.assert_allclose(here[:, 0].mean(), 2.5 / 16, rtol=1e-12)
    np.testing.assert_allclose(here[:, 2].mean(), 3.5 / 16, rtol=1e-12)
    assert np.ptp(here[:, 0]) < 1.0 / 16
    # the farthest corner decides the mask
    corner = np.hypot(*(np.array([6, 6]) / 16 * sphere.CAMERA_WIDTH))
    assert mask[2, 8] == (np.hypot(1, 6) / 16 * sphere.CAMERA_WIDTH <= sphere.MASK_RADIUS)
    assert mask[2, 2] == (corner <= sphere.MASK_RADIUS)
    assert not mask[0].any()
    np.testing.assert_array_equal(mask, mask[::-1, ::-1])


def test_frames_are_right_handed_with_the_tangent_around_z():
    points, mask = sphere.sphere_points(16, 2)
    x, y, z = sphere.local_frames(points[mask])
    np.testing.assert_allclose(np.cross(x, y), z, atol=1e-14)
    np.testing.assert_allclose((x * z).sum(axis=-1), 0.0, atol=1e-14)
    np.testing.assert_allclose(x[..., 2], 0.0, atol=1e-14)
    # counter-clockwise seen from +Z: at the point that faces the camera it runs to +X
    front = sphere.local_frames(np.array([0.0, -1.0, 0.0]))
    np.testing.assert_allclose(front[0], [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(front[1], [0.0, 0.0, 1.0], atol=1e-15)


@pytest.mark.parametrize("surface", [Surface(1.0, 0.1), Surface(0.5, 0.5, BECKMANN)])
def test_white_sphere_vanishes_in_the_furnace(surface):
    picture = sphere.furnace_picture(surface, 4, 1, resolution=16)
    inside = picture["mask"] > 0.0
    z = (picture["mean"][inside] - 1.0)[:, 0] / np.maximum(picture["error"][inside][:, 0], 1e-9)
    # 4 standard errors leave one chance in 16 000 a pixel, of 150 pixels
    assert np.abs(z).max() < 4.0
    np.testing.assert_array_equal(picture["mean"][~inside], 0.0)


def test_picture_is_the_brdf_at_its_points():
    surface = Surface(0.5, 0.5)
    picture = sphere.sun_picture(surface, 8, 3, resolution=16)
    points, _ = sphere.sphere_points(16)
    frames = sphere.local_frames(points[8, 9])
    wi = sphere.to_local(sphere.VIEW_DIRECTION, frames)
    wo = sphere.to_local(sphere.SUN_DIRECTION, frames)
    expected = first_bounce(wi, wo, surface).mean(axis=0)
    np.testing.assert_allclose(picture["single"][8, 9], expected, rtol=1e-12)
    assert np.all(picture["mean"] >= picture["single"])
    # the lower left is turned away from the sun
    assert picture["mask"][11, 2] == 1.0
    np.testing.assert_array_equal(picture["mean"][11, 2], 0.0)


def test_exr_keeps_layers_and_metadata(tmp_path):
    rng = np.random.default_rng(0)
    layers = {"mean": rng.random((4, 6, 3)), "error": rng.random((4, 6, 3)), "mask": np.eye(4, 6)}
    exr.write(tmp_path / "a.exr", layers, {"alpha": "0.5 0.1", "seed": "3"})
    found, metadata = exr.read(tmp_path / "a.exr")
    assert metadata == {"alpha": "0.5 0.1", "seed": "3"}
    assert set(found) == set(layers)
    for name, picture in layers.items():
        np.testing.assert_array_equal(found[name], picture.astype(np.float32))


def test_exr_errors_name_the_file(tmp_path):
    with pytest.raises(OSError, match=r"missing\.exr"):
        exr.read(tmp_path / "missing.exr")
    with pytest.raises(OSError, match="cannot write"):
        exr.write(tmp_path / "none" / "a.exr", {"mean": np.zeros((2, 2, 3))}, {})
    with pytest.raises(ValueError, match="differ in size"):
        exr.write(tmp_path / "a.exr", {"mean": np.zeros((2, 2, 3)), "mask": np.zeros((3, 2))}, {})


def test_every_case_has_its_file_and_nothing_else_is_there():
    manifest = json.loads((references.FOLDER / "manifest.json").read_text(encoding="utf-8"))
    assert list(manifest) == [case.name for case in references.CASES]
    files = {entry["file"] for entry in manifest.values()}
    assert {path.name for path in references.FOLDER.glob("*.exr")} == files
    for case in references.CASES:
        entry = manifest[case.name]
        data = (references.FOLDER / entry["file"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == entry["sha256"]
        layers, metadata = exr.read(references.FOLDER / entry["file"])
        assert metadata == case.metadata(), "the case changed; make its reference again"
        assert references.relative_error(layers) <= 0.003


@pytest.mark.parametrize("case", references.CASES, ids=lambda case: case.name)
def test_reference_agrees_with_a_new_rendering_of_some_rows(case):
    stored, _ = exr.read(references.FOLDER / f"{case.name}.exr")
    render = sphere.furnace_picture if case.furnace else sphere.sun_picture
    walks = max(2, case.walks // 8)
    fresh = render(case.surface, walks, 1000 + case.seed, progress=lambda rows: ROWS)
    lit = (stored["mask"] > 0.0) & (stored["mean"].max(axis=-1) > 1e-4)
    lit[[row for row in range(len(lit)) if row not in ROWS]] = False
    assert lit.sum() > 50
    if "single" in stored:
        # float32 in the file
        np.testing.assert_allclose(stored["single"][lit], fresh["single"][lit], rtol=1e-6)
    difference = stored["mean"][lit] - fresh["mean"][lit]
    # errors are pooled before dividing: walks are skewed, so that a pixel with too low a mean has
    # too low an error as well, and single z-values lean to one side
    variance = stored["error"][lit] ** 2 + fresh["error"][lit] ** 2
    assert np.abs(difference.sum(axis=0) / np.sqrt(variance.sum(axis=0))).max() < 4.0
    # 57 pixels or more know their spread to 4 * sqrt(2 / 57) = 75 % at 4 standard errors
    spread = (difference**2).sum(axis=0) / variance.sum(axis=0)
    assert spread.min() > 0.25
    assert spread.max() < 1.75


def test_rows_of_a_picture_do_not_depend_on_each_other():
    surface = Surface(1.0, 1.0)
    whole = sphere.sun_picture(surface, 2, 5, resolution=16)
    row = sphere.sun_picture(surface, 2, 5, resolution=16, progress=lambda rows: [7])
    np.testing.assert_array_equal(row["mean"][7], whole["mean"][7])


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
