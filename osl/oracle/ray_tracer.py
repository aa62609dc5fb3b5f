# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays and a periodic height field in Embree.

Embree computes in single precision. It finds which facet is hit, and about where. Double precision
then moves the point onto the facet's plane. The next ray starts a little above or below it, on the
side where the ray goes on. This shift outweighs the rounding of the origin. It is vertical, so it
cannot pierce another facet of a height field. A ray that still meets a facet from the wrong side,
or passes the sheet without a hit, has leaked and is lost.
"""

from typing import NamedTuple

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from .height_field import HeightField
from .vectors import dot, normalize, vector

_CLEARANCE = 4.0  # between a facet and the start of a ray, in bounds of the height's rounding
_MAX_PERIODS = 64  # a ray that is still inside the slab after this many is dropped
_TILES = 32  # rays are sorted by tiles of the sheet, which suits the cache


class Arrival(NamedTuple):
    """Where rays get to.

    ``left`` ``(n,)``: they meet nothing more. ``lost`` ``(n,)``: they leaked. Otherwise ``m`` and
    ``point`` ``(n, 3)`` are the upper normal of the facet they meet, and the place.
    """

    m: np.ndarray
    point: np.ndarray
    left: np.ndarray
    lost: np.ndarray


class Tracer:
    """A height field in Embree; ``TypeError`` for anything but a `HeightField`."""

    def __init__(self, field: HeightField) -> None:
        if not isinstance(field, HeightField):
            raise TypeError(f"field is a {type(field).__name__}; give a HeightField")
        vertices, facets = field.mesh()
        slopes = field.facet_slopes().reshape(-1, 2)
        corner = vertices[facets[:, 0]]
        base = corner[:, 2] - (slopes * corner[:, :2]).sum(axis=1)
        # z = plane . (x, y, 1); rows, because they are gathered by facet
        self._planes = np.concatenate([slopes, base[:, None]], axis=1)
        self._half = 0.5 * field.size
        # bounds the terms of a facet's height; the spacing counts if all is flat
        reach = np.abs(slopes).max(axis=0) @ self._half + np.abs(field.heights).max()
        reach += max(field.spacing)
        self._shift = _CLEARANCE * float(np.finfo(np.float32).eps) * float(reach)
        self._slab = field.heights.min() - self._shift, field.heights.max() + self._shift
        self._scene = EmbreeScene(robust=True)
        # adds itself to the scene, which keeps a copy
        TriangleMesh(self._scene, vertices.astype(np.float32), facets.astype(np.int32))

    def start(self, rays: int, below: bool, rng: np.random.Generator) -> np.ndarray:
        """Random points ``(rays, 3)`` above the highest one, or ``below`` the lowest; neighbours
        are close to each other."""
        place = rng.random((2, rays))
        tile = (place * _TILES).astype(np.uint16)
        order = np.argsort(tile[0] * _TILES + tile[1], kind="stable")
        x, y = (2.0 * place[:, order] - 1.0) * self._half[:, None]
        return vector(x, y, np.float64(self._slab[0 if below else 1]))

    def follow(self, point: np.ndarray, travel: np.ndarray, below: np.ndarray) -> Arrival:
        """Follow rays on the side ``below`` ``(n,)`` from ``point`` along ``travel`` ``(n, 3)``."""
        facet, end, endless = self._next_facet(point, travel)
        plane = self._planes[facet]
        m = normalize(vector(-plane[:, 0], -plane[:, 1], np.float64(1.0)))
        end[:, 2] = plane[:, 0] * end[:, 0] + plane[:, 1] * end[:, 1] + plane[:, 2]
        met = facet >= 0
        left = ~met & ~endless & ((travel[:, 2] < 0.0) == below)
        on = met & ((dot(travel, m) > 0.0) == below)
        return Arrival(m, end, left, ~(left | on))

    def off(self, point: np.ndarray, below: np.ndarray) -> np.ndarray:
        """Where rays start from points of facets ``(n, 3)`` on the side ``below`` ``(n,)``."""
        shift = np.where(below, -self._shift, self._shift)
        return vector(point[:, 0], point[:, 1], point[:, 2] + shift)

    def _next_facet(
        self, point: np.ndarray, travel: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Numbers of the facets that rays meet ``(n,)``, -1 for none; about where, ``(n, 3)``; and
        whether they are still under way after all periods, ``(n,)``."""
        facet = np.full(point.shape[0], -1, dtype=np.int32)
        end = np.zeros_like(point)
        active = np.arange(point.shape[0])
        for _ in range(_MAX_PERIODS):
            found = self._scene.run(
                point.astype(np.float32, order="C"),
                travel.astype(np.float32, order="C"),
                output=True,
            )
            hit = found["primID"] >= 0
            facet[active[hit]] = found["primID"][hit]
            distance = found["tfar"][hit].astype(np.float64)
            end[active[hit]] = point[hit] + distance[:, None] * travel[hit]
            point, travel, active = point[~hit], travel[~hit], active[~hit]
            inside, entry = self._next_period(point, travel)
            point, travel, active = entry[inside], travel[inside], active[inside]
            if active.size == 0:
                break
        endless = np.zeros(facet.shape, bool)
        endless[active] = True
        return facet, end, endless

    def _next_period(self, at: np.ndarray, along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Whether rays that meet nothing reach the next period ``(n,)``, and where ``(n, 3)``.

        Otherwise they leave the slab between the highest and the lowest point before.
        """
        limit = np.where(along[:, 2] < 0.0, *self._slab)
        slow = np.where(along == 0.0, 1e-300, along)
        out = (limit - at[:, 2]) / slow[:, 2]
        side = np.copysign(self._half, slow[:, :2])
        distance = (side - at[:, :2]) / slow[:, :2]
        axis = np.argmin(distance, axis=1)
        row = np.arange(axis.size)
        distance = distance[row, axis]
        entry = at + distance[:, None] * along
        entry[row, axis] = -side[row, axis]
        return distance < out, entry
