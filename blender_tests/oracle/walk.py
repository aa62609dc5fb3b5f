# SPDX-License-Identifier: GPL-3.0-or-later
"""The height-correlated random walk inside the microgeometry, for conductors.

At a vertex the path arrives from v, meets a micronormal m drawn from Dvis(v, .), and turns to
o = 2 <v,m> m - v with weight F(<v,m>). It leaves with probability p_exit (eqs. 12, 14, 16-17):

    p_exit = sigma(v) o.z / (sigma(v) o.z + sigma(-o) |v.z|)   for o.z > 0, and 0 below the horizon

so that G1dist(v) p_exit is G2 of the last bounce (eqs. 12-13) and G1dist(v) (1 - p_exit) that of a
middle bounce (eq. 17). Otherwise the next vertex is met from v' = -o. A path carries the
probability of having stayed as part of its weight; light paths are thinned by Russian roulette.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .ndf import D, sigma
from .surface import Surface
from .vectors import above_horizon, dot, half_vector
from .visible import sample

ROULETTE = 0.05  # paths lighter than this survive with probability weight / ROULETTE


@dataclass(frozen=True)
class Vertex:
    """One bounce of the ``n`` walks that are still alive.

    ``walk`` ``(n,)``: which of the walks they are. ``v`` ``(n, 3)``, ``area`` = sigma(v) ``(n,)``
    and ``weight`` ``(n, C)`` on arrival; ``o``, ``reflected`` weight (after Fresnel), and the
    probabilities ``p_exit``, ``p_stay`` ``(n,)`` on departure.
    """

    walk: np.ndarray
    v: np.ndarray
    area: np.ndarray
    weight: np.ndarray
    o: np.ndarray
    reflected: np.ndarray
    p_exit: np.ndarray
    p_stay: np.ndarray

    @property
    def leaving(self) -> np.ndarray:
        """Weight that leaves at this bounce, ``(n, C)``."""
        return self.reflected * self.p_exit[:, None]

    @property
    def staying(self) -> np.ndarray:
        """Weight that goes on to the next bounce, ``(n, C)``."""
        return self.reflected * self.p_stay[:, None]


def exit_probability(v: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """p_exit (eqs. 12, 14, 16-17), shape ``(...)``, for ``v`` on either side of the horizon."""
    v, o = np.asarray(v, dtype=np.float64), np.asarray(o, dtype=np.float64)
    return _exit_odds(v, sigma(v, surface), o, sigma(-o, surface))[0]


def _exit_odds(
    v: np.ndarray, area_v: np.ndarray, o: np.ndarray, area_back: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """p_exit and 1 - p_exit, the second without cancellation; ``area_back`` is sigma(-o)."""
    leave = area_v * np.maximum(o[..., 2], 0.0)
    stay = area_back * np.abs(v[..., 2])
    both = leave + stay
    # Both vanish only where no micronormal is visible from v; such paths carry no weight.
    safe = np.where(both > 0.0, both, 1.0)
    up = o[..., 2] > 0.0
    return np.where(up, leave / safe, 0.0), np.where(up, stay / safe, 1.0)


def connection(
    v: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    area_v: np.ndarray | None = None,
    area_back: np.ndarray | None = None,
) -> np.ndarray:
    """Density per steradian to turn from ``v`` to ``wo`` (``wo.z > 0``) and leave, ``(..., C)``.

    F Dvis(v,h) / (4 <v,h>) p_exit = F D(h) wo.z / (4 (sigma(v) wo.z + sigma(-wo) |v.z|)).
    ``area_v`` = sigma(v) and ``area_back`` = sigma(-wo) may be given where they are known.
    """
    v, wo = np.asarray(v, dtype=np.float64), np.asarray(wo, dtype=np.float64)
    area_v = sigma(v, surface) if area_v is None else area_v
    area_back = sigma(-wo, surface) if area_back is None else area_back
    h = half_vector(v, wo)
    odds = area_v * wo[..., 2] + area_back * np.abs(v[..., 2])
    # odds = 0 needs sigma(v) = 0, where D(h) underflows to 0 as well
    value = D(h, surface) * wo[..., 2] / (4.0 * np.where(odds > 0.0, odds, 1.0))
    return surface.fresnel(np.maximum(dot(v, h), 0.0)) * value[..., None]


def first_bounce(wi: np.ndarray, wo: np.ndarray, surface: Surface) -> np.ndarray:
    """Single-bounce BRDF times cos(wo): F D G2 / (4 |cos i|), shape ``(..., 3)``, per steradian.

    ``wi`` and ``wo`` broadcast; both must be above the surface, else ``ValueError``.
    """
    wi, wo = np.broadcast_arrays(above_horizon(wi, "wi"), above_horizon(wo, "wo"))
    value = connection(wi, wo, surface)
    return np.broadcast_to(value, (*value.shape[:-1], 3)).copy()


def bounces(
    wi: np.ndarray,
    surface: Surface,
    max_bounces: int,
    rng: np.random.Generator,
    roulette: float = ROULETTE,
) -> Iterator[Vertex]:
    """Walk from each of ``wi`` ``(n, 3)``; yields bounce 1, 2, ... until ``max_bounces``, or until
    no walk is alive. ``roulette`` 0 ends only walks whose weight is 0."""
    v = np.asarray(wi, dtype=np.float64)
    walk = np.arange(v.shape[0])
    area = sigma(v, surface)
    weight = np.ones((v.shape[0], 1))
    for _ in range(max_bounces):
        m = sample(v, surface, rng)
        cosine = np.maximum(dot(v, m), 0.0)
        o = 2.0 * cosine[:, None] * m - v
        back = -o
        area_back = sigma(back, surface)
        p_exit, p_stay = _exit_odds(v, area, o, area_back)
        vertex = Vertex(walk, v, area, weight, o, weight * surface.fresnel(cosine), p_exit, p_stay)
        yield vertex
        weight = vertex.staying
        chance = weight.max(axis=1) / max(roulette, 1e-300)
        alive = np.flatnonzero(rng.random(walk.size) < chance)
        if alive.size == 0:
            return
        weight = weight[alive] / np.minimum(chance[alive], 1.0)[:, None]
        walk, area = walk[alive], area_back[alive]
        v = np.ascontiguousarray(back.T[:, alive]).T
