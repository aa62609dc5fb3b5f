# SPDX-License-Identifier: GPL-3.0-or-later
"""The random walk inside the microgeometry, and the value of a walk towards a given direction.

At a vertex the path arrives from v and meets a micronormal m drawn from Dvis(v, .). The facet's
material turns it to o. It leaves with the chance p_exit of its model (masking.py), which is 0 below
the horizon. Otherwise it meets the next vertex from v' = -o. Its weight contains the chance of
having stayed. Russian roulette thins light paths.

On each side of the surface directions are those of its own frame (materials.py): below, the common
frame with all directions negated.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from .checks import count, number
from .masking import exit_odds, first_height, height_from_below, next_height
from .materials import Bounce
from .ndf import D, sigma
from .surface import CORRELATED, HEIGHT_TRACKED, Surface
from .vectors import outside, to_side
from .visible import sample

ROULETTE = 0.05  # paths lighter than this survive with probability weight / ROULETTE


@dataclass(frozen=True)
class Vertex(Bounce):
    """One bounce of the ``n`` walks that are still alive.

    Besides `Bounce`, on arrival: ``area`` = sigma(v) ``(n,)``; ``weight`` ``(n, C)``; ``log_u``
    ``(n,)``, the height (in the height-tracked model, else None). Afterwards: the ``scattered``
    weight ``(n, C)``; the chances ``p_exit`` and ``p_stay`` ``(n,)``.
    """

    area: np.ndarray
    weight: np.ndarray
    log_u: np.ndarray | None
    scattered: np.ndarray
    p_exit: np.ndarray
    p_stay: np.ndarray

    @property
    def leaving(self) -> np.ndarray:
        """Weight that leaves at this bounce, ``(n, C)``."""
        return self.scattered * self.p_exit[:, None]

    @property
    def staying(self) -> np.ndarray:
        """Weight that goes on to the next bounce, ``(n, C)``."""
        return self.scattered * self.p_stay[:, None]


def bounces(
    wi: np.ndarray,
    surface: Surface,
    max_bounces: int,
    rng: np.random.Generator,
    roulette: float = ROULETTE,
) -> Iterator[Vertex]:
    """Bounce 1, 2, ... of walks from each ``wi`` ``(n, 3)``, until ``max_bounces`` or all ended.

    ``roulette``, 0 to 1: 0 ends only walks whose weight is 0. Raises ``ValueError`` for directions
    that are not unit vectors above the surface (either side of it where it transmits), and for
    counts and numbers out of range.
    """
    number(roulette, "roulette", 0.0, 1.0, "weight")
    v, below = to_side(outside(wi, "wi", surface.material.transmits))
    walk = np.arange(v.shape[0])
    area = sigma(v, surface)
    weight = np.ones((v.shape[0], 1))
    log_u = first_height(v, area, rng) if surface.model == HEIGHT_TRACKED else None
    for _ in range(count(max_bounces, "max_bounces", 1)):
        m = sample(v, surface, rng)
        o, crossed, factor = surface.material.scatter(v, m, below, rng)
        back = -o
        area_back = sigma(back, surface)
        after = _height_after(log_u, crossed)
        odds = exit_odds(v, area, o, area_back, crossed, after, surface.model)
        vertex = Vertex(walk, v, below, m, o, crossed, area, weight, log_u, weight * factor, *odds)
        yield vertex
        weight = vertex.staying
        chance = weight.max(axis=1) / max(roulette, 1e-300)
        alive = np.flatnonzero(rng.random(walk.size) < chance)
        if alive.size == 0:
            return
        weight = weight[alive] / np.minimum(chance[alive], 1.0)[:, None]
        walk, below, area = walk[alive], vertex.below_after[alive], area_back[alive]
        v = np.ascontiguousarray(back.T[:, alive]).T
        if log_u is not None:
            log_u = next_height(after[alive], -v, area, rng)


def connection(vertex: Vertex, wo: np.ndarray, surface: Surface) -> np.ndarray:
    """Weight per steradian with which walks turn to ``wo`` at ``vertex`` and leave, ``(n, C)``.

    ``wo`` ``(3,)`` or ``(n, 3)``, on either side of the surface.
    """
    o, wo_below = to_side(np.broadcast_to(wo, vertex.v.shape))
    crossed = vertex.below ^ wo_below
    return vertex.weight * turn_and_leave(
        vertex.v, o, surface, vertex.below, crossed, vertex.area, vertex.m, vertex.log_u
    )


def turn_and_leave(
    v: np.ndarray,
    o: np.ndarray,
    surface: Surface,
    below: np.ndarray | bool = False,
    crossed: np.ndarray | bool = False,
    area_v: np.ndarray | None = None,
    m: np.ndarray | None = None,
    log_u: np.ndarray | None = None,
) -> np.ndarray:
    """Density per steradian of turning from ``v`` to ``o`` and leaving, ``(..., C)``.

    ``v`` and ``o`` in the frames of their sides; ``area_v`` = sigma(v) if it is known. For smooth
    facets this is the vertex term over sigma(v), times p_exit. A mirror has
    F D(h) / (4 sigma(v)) p_exit. For rough ones it is the density at the facet ``m``, and the
    caller takes the mean over Dvis(v, .). The height-tracked model takes the height on arrival,
    ``log_u``. ``ValueError`` for a dielectric of IOR 1.
    """
    v, o = np.broadcast_arrays(np.asarray(v, float), np.asarray(o, float))
    below, crossed = np.broadcast_to(below, v.shape[:-1]), np.broadcast_to(crossed, v.shape[:-1])
    area_v = sigma(v, surface) if area_v is None else area_v
    log_u = _height_after(log_u, crossed)
    p_exit = exit_odds(v, area_v, o, sigma(-o, surface), crossed, log_u, surface.model).p_exit
    if surface.material.smooth:
        turn = surface.material.turn(v, o, None, below, crossed, partial(D, surface=surface))
        # sigma(v) = 0 only if D underflows as well
        density = turn.density / np.where(area_v > 0.0, area_v, 1.0)
        return turn.weight * (density * p_exit)[..., None]
    return surface.material.at_facet(o, m, crossed) * p_exit[..., None]


def first_bounce(wi: np.ndarray, wo: np.ndarray, surface: Surface) -> np.ndarray:
    """Single-bounce BSDF times |cos(wo)| of smooth facets, ``(..., 3)``, per steradian.

    For a mirror F D G2 / (4 |cos i|). ``wi`` and ``wo`` broadcast; they point away from the
    surface, and may lie below it only if it transmits. The mean over heights of the
    height-tracked model is the height-correlated one (eq. 15). ``ValueError`` for other directions,
    for rough facets, which have no closed form, and for a dielectric of IOR 1.
    """
    if not surface.material.smooth:
        raise ValueError(f"{surface.material} has no closed first bounce; use evaluate")
    wi, wo = pairs(wi, wo, surface)
    (v, below), (o, wo_below) = to_side(wi), to_side(wo)
    if surface.model == HEIGHT_TRACKED:
        surface = replace(surface, model=CORRELATED)
    value = turn_and_leave(v, o, surface, below, below ^ wo_below)
    return np.broadcast_to(value, (*value.shape[:-1], 3)).copy()


def pairs(wi: np.ndarray, wo: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """``wi`` and ``wo`` broadcast to one shape ``(..., 3)``, each checked as in `first_bounce`."""
    transmits = surface.material.transmits
    return np.broadcast_arrays(outside(wi, "wi", transmits), outside(wo, "wo", transmits))


def _height_after(log_u: np.ndarray | None, crossed: np.ndarray) -> np.ndarray | None:
    """The height seen from the side that the path is on after the vertex."""
    return None if log_u is None else np.where(crossed, height_from_below(log_u), log_u)
