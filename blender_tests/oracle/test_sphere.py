# SPDX-License-Identifier: GPL-3.0-or-later
"""The views of the sphere and of the slab, and pictures of them."""

import numpy as np
import pytest

from osl.oracle import BECKMANN, GGX, Dielectric, Diffuse, Surface, first_bounce, slab, sphere
from osl.oracle import picture as pictures
from osl.oracle.vectors import dot, normalize
from osl.oracle.view import to_local


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


def test_inside_out_the_viewer_is_below_the_surface():
    outside, inside = sphere.view(16, 2), sphere.view(16, 2, inside_out=True)
    np.testing.assert_array_equal(inside.axes[2], -outside.axes[2])
    np.testing.assert_array_equal(inside.mask, outside.mask)
    x, y, z = (axis[inside.mask] for axis in inside.axes)
    np.testing.assert_allclose(np.cross(x, y), z, atol=1e-14)
    row = np.flatnonzero(inside.mask.any(axis=1))[0]
    assert np.all(outside.row(row)[0][..., 2] > 0.0)
    assert np.all(inside.row(row)[0][..., 2] < 0.0)


def test_pixels_lit_from_above_face_the_sun_with_all_their_points():
    whole = sphere.view(32, 4)
    lit = whole.lit_from_above(sphere.FRONT_SUN)
    facing = dot(whole.axes[2], sphere.FRONT_SUN) > 0.0
    assert facing[lit.mask].all()
    left_out = whole.mask & ~lit.mask
    assert not facing[left_out].all(axis=-1).any()
    assert 0 < left_out.sum() < lit.mask.sum()


def test_slab_is_seen_from_where_its_camera_looks():
    view = slab.view(16, 4)
    assert view.mask.all()
    # the picture's centre is the corner of four pixels
    centre = view.viewer[7:9, 7:9].mean(axis=(0, 1, 2))
    np.testing.assert_allclose(normalize(centre), -slab.CAMERA_DIRECTION, atol=1e-14)
    # along the middle column 50 degrees, less half a subpixel at each end
    middle = normalize(view.viewer[:, 7:9].mean(axis=(1, 2)))
    assert np.all(np.diff(middle[:, 2]) > 0.0)  # the top row looks at it most grazing
    top, bottom = view.viewer[0, 8, 0], view.viewer[-1, 8, -1]
    span = np.arccos(dot(top, bottom) / np.hypot(top[1], top[2]))
    assert span == pytest.approx(slab.CAMERA_ANGLE, abs=0.06)
    # what lies right in the picture is seen from its left
    assert view.viewer[8, 0, 0, 0] > 0.0 > view.viewer[8, -1, 0, 0]
    assert np.all(view.viewer[..., 2] > 0.0)
    assert slab.SUN[2] < 0.0


@pytest.mark.parametrize("surface", [Surface(1.0, 0.1), Surface(0.5, 0.5, BECKMANN)])
def test_white_sphere_vanishes_in_the_furnace(surface):
    picture = pictures.furnace_picture(sphere.view(16), surface, 4, 1)
    inside = picture["mask"] > 0.0
    z = (picture["mean"][inside] - 1.0)[:, 0] / np.maximum(picture["error"][inside][:, 0], 1e-9)
    # 4 standard errors leave one chance in 16 000 a pixel, of 150 pixels
    assert np.abs(z).max() < 4.0
    np.testing.assert_array_equal(picture["mean"][~inside], 0.0)


def test_picture_is_the_brdf_at_its_points():
    surface, view = Surface(0.5, 0.5), sphere.view(16)
    picture = pictures.sun_picture(view, sphere.FRONT_SUN, surface, 8, 3)
    points, _ = sphere.sphere_points(16)
    frames = sphere.local_frames(points[8, 9])
    wi = to_local(sphere.VIEW_DIRECTION, frames)
    wo = to_local(sphere.FRONT_SUN, frames)
    expected = first_bounce(wi, wo, surface).mean(axis=0)
    np.testing.assert_allclose(picture["single"][8, 9], expected, rtol=1e-12)
    assert np.all(picture["mean"] >= picture["single"])
    # the lower left is turned away from the sun
    assert picture["mask"][11, 2] == 1.0
    np.testing.assert_array_equal(picture["mean"][11, 2], 0.0)


def test_light_from_behind_comes_through_glass_alone():
    view, centre = sphere.view(16, 2), (slice(7, 9), slice(7, 9))
    for material, through in ((Dielectric(1.5), True), (Diffuse(), False)):
        surface = Surface(0.5, 0.5, GGX, material)
        picture = pictures.sun_picture(view, sphere.BACK_SUN, surface, 2, 1)
        assert np.all((picture["single"][centre] > 0.01) == through)
        assert np.all((picture["mean"][centre] > 0.01) == through)


@pytest.mark.nightly
def test_inside_out_glass_is_glass_of_the_inverse_index():
    """Two ways to write the same: a viewer below the surface, and a medium turned around."""
    found = []
    for ior, inside_out in ((1.5, True), (1.0 / 1.5, False)):
        surface = Surface(0.5, 0.5, GGX, Dielectric(ior))
        view = sphere.view(16, 4, inside_out)
        found.append(pictures.sun_picture(view, sphere.BACK_SUN, surface, 400, 7))
    inside, inverse = found
    np.testing.assert_allclose(inside["single"], inverse["single"], rtol=1e-9)
    difference = (inside["mean"] - inverse["mean"])[..., 0]
    variance = (inside["error"] ** 2 + inverse["error"] ** 2)[..., 0]
    assert abs(difference.sum()) < 4.0 * np.sqrt(variance.sum())
    # both sums are of walks: 1 % of the picture is 4 standard errors or more of it
    assert np.sqrt(variance.sum()) < 0.0025 * inside["mean"][..., 0].sum()


def test_rows_of_a_picture_do_not_depend_on_each_other():
    surface, view = Surface(1.0, 1.0), sphere.view(16)
    whole = pictures.sun_picture(view, sphere.FRONT_SUN, surface, 2, 5)
    row = pictures.sun_picture(view, sphere.FRONT_SUN, surface, 2, 5, progress=lambda rows: [7])
    np.testing.assert_array_equal(row["mean"][7], whole["mean"][7])
