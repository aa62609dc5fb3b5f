# SPDX-License-Identifier: GPL-3.0-or-later
"""The height-correlated random walk inside the microgeometry, for conductors.

At a vertex the path arrives from v, meets a micronormal m drawn from Dvis(v, .), and turns to
o = 2 <v,m> m - v with weight F(<v,m>). It leaves with probability p_exit (eqs. 12, 14, 16-17):

    p_exit = sigma(v) o.z / (sigma(v) o.z + sigma(-o) |v.z|)   for o.z > 0, and 0 below the horizon

so that G1dist(v) p_exit is G2 of the last bounce (eqs. 12-13) and G1dist(v) (1 - p_exit) that of a
middle bounce (eq. 17). Otherwise the next vertex is met from v' = -o. Paths never die here: they
carry the probability of having stayed as part of their weight.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from .ndf import D, sigma
from .surface import Surface
from .vectors import above_horizon, dot, half_vector
from .visible import sample

_BATCH = 1 << 15  # walks advanced together: their arrays fit the cache


@dataclass(frozen=True)
class Bounces:
    """Estimates per bounce, first axis bounce 1, 2, ...; last axis red, green, blue.

    ``mean`` and ``variance`` (of the mean) have shape ``(bounces, ..., 3)``; ``remaining``
    ``(..., 3)`` is the mean weight still inside after the last bounce, the truncated energy.
    ``total_variance`` ``(..., 3)`` is the variance of the sum over bounces, which are correlated.
    """

    mean: np.ndarray
    variance: np.ndarray
    total_variance: np.ndarray
    remaining: np.ndarray

    @property
    def standard_error(self) -> np.ndarray:
        """Square root of ``variance``."""
        return np.sqrt(self.variance)

    @property
    def total(self) -> np.ndarray:
        """Sum over bounces, ``(..., 3)``."""
        return self.mean.sum(axis=0)


@dataclass(frozen=True)
class Vertex:
    """One bounce of ``n`` walks: arrival ``v`` and ``weight`` on arrival, departure ``o``, the
    ``reflected`` weight (after Fresnel) and the probability ``p_exit`` to leave along ``o``."""

    v: np.ndarray
    weight: np.ndarray
    o: np.ndarray
    reflected: np.ndarray
    p_exit: np.ndarray


def exit_probability(v: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """p_exit (eqs. 12, 14, 16-17), shape ``(...)``, for ``v`` on either side of the horizon."""
    return _exit_odds(v, o, surface)[0]


def _exit_odds(v: np.ndarray, o: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """p_exit and 1 - p_exit, the second without cancellation."""
    leave = sigma(v, surface) * np.maximum(o[..., 2], 0.0)
    stay = sigma(-o, surface) * np.abs(v[..., 2])
    both = leave + stay
    # Both vanish only where no micronormal is visible from v; such paths carry no weight.
    safe = np.where(both > 0.0, both, 1.0)
    up = o[..., 2] > 0.0
    return np.where(up, leave / safe, 0.0), np.where(up, stay / safe, 1.0)


def connection(v: np.ndarray, wo: np.ndarray, surface: Surface) -> np.ndarray:
    """Density per steradian to turn from ``v`` to ``wo`` and leave, shape ``(..., C)``.

    F Dvis(v,h) / (4 <v,h>) p_exit = F D(h) wo.z / (4 (sigma(v) wo.z + sigma(-wo) |v.z|)).
    """
    h = half_vector(v, wo)
    odds = sigma(v, surface) * wo[..., 2] + sigma(-wo, surface) * np.abs(v[..., 2])
    # odds = 0 needs sigma(v) = 0, where D(h) underflows to 0 as well
    value = D(h, surface) * wo[..., 2] / (4.0 * np.where(odds > 0.0, odds, 1.0))
    return surface.fresnel(np.maximum(dot(v, h), 0.0)) * value[..., None]


def first_bounce(wi: np.ndarray, wo: np.ndarray, surface: Surface) -> np.ndarray:
    """Single-bounce BRDF times cos(wo): F D G2 / (4 |cos i|), shape ``(..., 3)``, per steradian.

    ``wi`` and ``wo`` broadcast; both must be above the surface, else ``ValueError``.
    """
    wi, wo = above_horizon(wi, "wi"), above_horizon(wo, "wo")
    wi, wo = np.broadcast_arrays(wi, wo)
    return _rgb(connection(wi, wo, surface))


def bounces(
    wi: np.ndarray, surface: Surface, max_bounces: int, rng: np.random.Generator
) -> Iterator[Vertex]:
    """Walk from each of ``wi`` ``(n, 3)``; yields bounce 1, 2, ... ``max_bounces``."""
    v = np.asarray(wi, dtype=np.float64)
    weight = np.ones((v.shape[0], 1))
    for _ in range(max_bounces):
        m = sample(v, surface, rng)
        cosine = np.maximum(dot(v, m), 0.0)
        o = 2.0 * cosine[:, None] * m - v
        p_exit, p_stay = _exit_odds(v, o, surface)
        reflected = weight * surface.fresnel(cosine)
        yield Vertex(v, weight, o, reflected, p_exit)
        v, weight = -o, reflected * p_stay[:, None]


def energies(
    wi: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
) -> Bounces:
    """Energy that leaves at each bounce for light arriving from ``wi`` ``(..., 3)``.

    By the equality of both integrals this is also the radiance seen from ``wi`` in a uniform world
    of radiance 1. ``walks`` per direction, at least 2; ``rng`` a Generator or a seed.
    """

    def tally(step: Vertex, _: slice) -> np.ndarray:
        return step.reflected * step.p_exit[:, None]

    return _average(above_horizon(wi, "wi"), surface, max_bounces, walks, rng, tally)


def evaluate(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
) -> Bounces:
    """BRDF times cos(wo) at each bounce, per steradian, by connecting every vertex to ``wo``.

    ``wi`` and ``wo`` broadcast to ``(..., 3)``, each pair with ``walks`` walks of its own. Bounce 1
    is exact: all walks share their first vertex, so its variance is 0 but for rounding.
    """
    wi, wo = np.broadcast_arrays(above_horizon(wi, "wi"), above_horizon(wo, "wo"))
    target = wo.reshape(-1, 3)

    def tally(step: Vertex, pairs: slice) -> np.ndarray:
        per_pair = step.v.shape[0] // (pairs.stop - pairs.start)
        wo_here = np.repeat(target[pairs], per_pair, axis=0)
        return step.weight * connection(step.v, wo_here, surface)

    return _average(wi, surface, max_bounces, walks, rng, tally)


def lobe(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
) -> Bounces:
    """BRDF times cos(wo) of one ``wi`` ``(3,)`` against many ``wo`` ``(..., 3)``, per steradian.

    All ``wo`` see the same walks, so the error is smooth over the lobe. Returns as `evaluate`.
    """
    wi, wo = above_horizon(wi, "wi"), above_horizon(wo, "wo")
    if wi.shape != (3,):
        raise ValueError(f"wi has shape {wi.shape}; a lobe belongs to one direction, shape (3,)")
    target = wo.reshape(-1, 3)
    rng = np.random.default_rng(rng)
    sums = _Sums(max_bounces, target.shape[0], walks)
    for count in _batches(walks):
        total = np.zeros((target.shape[0], count, 3))
        inside = np.ones((count, 1))
        start = np.broadcast_to(wi, (count, 3))
        for k, step in enumerate(bounces(start, surface, max_bounces, rng)):
            for j, one in enumerate(target):
                value = step.weight * connection(step.v, one, surface)
                total[j] += value
                sums.add(k, j, value)
            inside = step.reflected * (1.0 - step.p_exit)[:, None]
        sums.finish(slice(0, None), total, np.broadcast_to(inside, (target.shape[0], count, 3)))
    return sums.result(wo.shape[:-1])


def _average(
    wi: np.ndarray,
    surface: Surface,
    max_bounces: int,
    walks: int,
    rng: np.random.Generator | int,
    tally: Callable[[Vertex, slice], np.ndarray],
) -> Bounces:
    """Mean and variance of ``tally`` over the walks of every direction ``wi`` ``(..., 3)``."""
    rng = np.random.default_rng(rng)
    flat = wi.reshape(-1, 3)
    sums = _Sums(max_bounces, flat.shape[0], walks)
    group = max(1, _BATCH // walks)
    for first in range(0, flat.shape[0], group):
        pairs = slice(first, min(first + group, flat.shape[0]))
        size = pairs.stop - pairs.start
        for count in _batches(walks):
            total = np.zeros((size, count, 3))
            start = np.repeat(flat[pairs], count, axis=0)
            for k, step in enumerate(bounces(start, surface, max_bounces, rng)):
                value = tally(step, pairs).reshape(size, count, -1)
                total += value
                sums.add(k, pairs, value)
                inside = step.reflected * (1.0 - step.p_exit)[:, None]
            sums.finish(pairs, total, inside.reshape(size, count, -1))
    return sums.result(wi.shape[:-1])


def _batches(walks: int) -> Iterator[int]:
    while walks > 0:
        yield min(walks, _BATCH)
        walks -= _BATCH


class _Sums:
    """Running first and second moments per bounce and direction."""

    def __init__(self, max_bounces: int, directions: int, walks: int) -> None:
        if max_bounces < 1:
            raise ValueError(f"max_bounces is {max_bounces}; give 1 or more")
        if walks < 2:
            raise ValueError(f"walks is {walks}; give 2 or more, so that the variance is defined")
        self.walks = walks
        self.first = np.zeros((max_bounces + 1, directions, 3))
        self.second = np.zeros((max_bounces + 1, directions, 3))
        self.remaining = np.zeros((directions, 3))

    def add(self, row: int, columns: slice | int, value: np.ndarray) -> None:
        """Add values ``(..., walks, C)`` of one bounce; the last row is the sum over bounces."""
        self.first[row, columns] += value.sum(axis=-2)
        self.second[row, columns] += (value * value).sum(axis=-2)

    def finish(self, columns: slice, total: np.ndarray, inside: np.ndarray) -> None:
        """Add the sum over bounces and the weight left inside of finished walks."""
        self.add(-1, columns, total)
        self.remaining[columns] += inside.sum(axis=-2)

    def result(self, shape: tuple[int, ...]) -> Bounces:
        mean = self.first / self.walks
        spread = np.maximum(self.second / self.walks - mean * mean, 0.0)
        variance = (spread / (self.walks - 1)).reshape(-1, *shape, 3)
        mean = mean.reshape(-1, *shape, 3)
        remaining = (self.remaining / self.walks).reshape(*shape, 3)
        return Bounces(mean[:-1], variance[:-1], variance[-1], remaining)


def _rgb(value: np.ndarray) -> np.ndarray:
    return np.broadcast_to(value, (*value.shape[:-1], 3)).copy()
