# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures by the oracle what a sphere lacks if its light ends after n bounces.

The difference is taken as a picture and as energy.
"""

from collections.abc import Callable, Iterator

import numpy as np

from osl.oracle import (
    BECKMANN,
    CORRELATED,
    GGX,
    HEIGHT_TRACKED,
    UNCORRELATED,
    Conductor,
    Diffuse,
    Surface,
    energies,
    evaluate,
    sphere,
)
from osl.oracle.balanced import BalancedDielectric
from osl.oracle.materials import Material
from osl.oracle.view import to_local

SEED = 1
WALKS = 2000  # at each point, for a relative error of 2 % in the largest entries
ALPHAS = (0.02, 0.05, 0.1, 0.15, 0.25, 0.35, 0.5, 0.7, 0.85, 1.0)
INDICES = (1.05, 1.5, 2.5)  # of glass
DISTRIBUTIONS = (GGX, BECKMANN)
MODELS = (CORRELATED, UNCORRELATED, HEIGHT_TRACKED)
BOUNCES = 24
SMALLEST = 5e-5

_RESOLUTION = 16  # points of the sphere across the picture
# Closer to the horizon an opaque surface sends too little light for walks to measure.
_LOWEST_SUN = 0.02
_SUN, _BACK = sphere.FRONT_SUN, sphere.BACK_SUN


def rows(measure: Callable[[Surface], tuple[float, ...]]) -> Iterator[dict]:
    """Yield a row for each kind, distribution, model and, for glass, index.

    measure -- left_out() or energy_lost(). `after` in a row has its result at each of ALPHAS.
    """
    materials: list[tuple[str, float, Material]] = [
        ("CONDUCTOR", 0.0, Conductor()),
        ("DIFFUSE", 0.0, Diffuse()),
        *(("DIELECTRIC", ior, BalancedDielectric(ior)) for ior in INDICES),
    ]
    for kind, ior, material in materials:
        for number, model in enumerate(MODELS):
            for distribution in DISTRIBUTIONS:
                surfaces = [Surface(a, a, distribution, material, model) for a in ALPHAS]
                yield {
                    "kind": kind,
                    "distribution": distribution,
                    "model": number,
                    "ior": ior,
                    "after": [measure(surface) for surface in surfaces],
                }


def left_out(surface: Surface, walks: int = WALKS, seed: int = SEED) -> tuple[float, ...]:
    """Return the image L2 of what is missing after bounce 1, 2, ..., over that of all bounces.

    Facets absorb nothing. For coloured facets, powers of their colour scale the result. It is the
    largest of several pictures of a sphere: under the sun and in a uniform world, for glass also
    with the sun behind and seen from inside the solid. Entries below SMALLEST are left out.
    """
    glass = surface.material.transmits
    pictures = [
        light(surface, sun, inside, walks, seed)
        for sun, inside in ((_SUN, False), (None, False), (_BACK, False), (_BACK, True))
        if glass or sun is not _BACK
    ]
    return _down_to_smallest([missing(picture) for picture in pictures])


def energy_lost(surface: Surface, walks: int = WALKS, seed: int = SEED) -> tuple[float, ...]:
    """Return the energy that is missing after bounce 1, 2, ..., over that of all bounces.

    Facets absorb nothing. The energy is that of a sphere's whole picture in a uniform world. For
    glass it is the larger of that and of the view from inside the solid. Entries below SMALLEST are
    left out.
    """
    sides = (False, True) if surface.material.transmits else (False,)
    worlds = [light(surface, None, inside, walks, seed).mean(axis=(1, 2)) for inside in sides]
    return _down_to_smallest(
        [[world[k:].sum() / world.sum() for k in range(1, BOUNCES)] for world in worlds]
    )


def _down_to_smallest(parts: list[list[float]]) -> tuple[float, ...]:
    most = np.max(parts, axis=0)
    return tuple(float(part) for part in most[most > SMALLEST])


def light(
    surface: Surface, sun: np.ndarray | None, inside: bool, walks: int, seed: int
) -> np.ndarray:
    """Return the light of each bounce, ``(BOUNCES, n, 3)``, at points even in the picture.

    sun -- direction to the sun, a unit vector; None for a uniform world
    """
    points, mask = sphere.sphere_points(_RESOLUTION, 1)
    normals = points[mask].reshape(-1, 3)
    axes = sphere.local_frames(-normals if inside else normals)
    wi = to_local(sphere.VIEW_DIRECTION, axes)
    if sun is None:
        return energies(wi, surface, BOUNCES, walks, seed).both.mean
    wo = to_local(sun, axes)
    if not surface.material.transmits:
        lit = wo[:, 2] > _LOWEST_SUN
        wi, wo = wi[lit], wo[lit]
    return evaluate(wi, wo, surface, BOUNCES, walks, seed).mean


def missing(picture: np.ndarray) -> list[float]:
    """Return the norm of what `picture` lacks after bounce 1, 2, ..., over that of all bounces."""
    whole = np.linalg.norm(picture.sum(axis=0))
    return [float(np.linalg.norm(picture[k:].sum(axis=0)) / whole) for k in range(1, BOUNCES)]
