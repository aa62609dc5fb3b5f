# SPDX-License-Identifier: GPL-3.0-or-later
"""Means over many walks, with their standard errors: energies per bounce and values of the BSDF."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .checks import count, generator
from .surface import Surface
from .vectors import outside
from .walk import ROULETTE, Vertex, bounces, connection, first_bounce, pairs

_BATCH = 1 << 15  # walks that advance together; their arrays fit into the cache


@dataclass(frozen=True)
class Bounces:
    """Estimates per bounce: the first axis is bounce 1, 2, ..., the last one red, green, blue.

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
class Energies:
    """Energies per bounce: E_r ``reflected``, E_t ``transmitted``, and ``both`` together.

    Reflected light leaves on the side that it came from. Energy that is still inside may go either
    way if the surface transmits. Then ``remaining`` is nan in the two parts.
    """

    reflected: Bounces
    transmitted: Bounces
    both: Bounces


def energies(
    wi: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
    roulette: float = ROULETTE,
) -> Energies:
    """Energy that leaves at each bounce of walks that start towards ``wi`` ``(..., 3)``.

    Both integrals are equal, so this is also what ``wi`` sees in a uniform world of radiance 1 (of
    basic radiance 1 across a dielectric). ``walks`` per direction, at least 2; ``rng`` a Generator
    or a seed. Walks lighter than ``roulette`` are thinned at random. If all bounces after the first
    are faint, few heavy walks survive, and ``roulette`` 0 gives the sounder error. Raises
    ``ValueError`` for directions that are not unit vectors above the surface (either side of it
    where it transmits), and for counts that are too small.
    """
    wi = outside(wi, "wi", surface.material.transmits)
    flat = wi.reshape(-1, 3)
    rng = generator(rng)
    start_below = flat[:, 2] < 0.0
    kept = [Moments(max_bounces, flat.shape[0], walks, surface) for _ in range(3)]
    reflected, transmitted, both = kept
    for rows, each in batches(flat.shape[0], walks):
        for moments in kept:
            moments.start(rows, each)
        start = np.repeat(flat[rows], each, axis=0)
        for k, step in enumerate(bounces(start, surface, max_bounces, rng, roulette)):
            leaving = step.leaving
            both.add(k, step.walk, leaving)
            if surface.material.transmits:
                through = step.below_after ^ start_below[rows][step.walk // each]
                reflected.add(k, step.walk, np.where(through[:, None], 0.0, leaving))
                transmitted.add(k, step.walk, np.where(through[:, None], leaving, 0.0))
        for moments in kept:
            moments.finish(step if k == max_bounces - 1 else None)
    if surface.material.transmits:
        reflected.remaining[:] = transmitted.remaining[:] = np.nan
    else:
        reflected, transmitted.remaining[:] = both, 0.0
    return Energies(*(one.result(wi.shape[:-1]) for one in (reflected, transmitted, both)))


def evaluate(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
    roulette: float = ROULETTE,
) -> Bounces:
    """BSDF times |cos(wo)| at each bounce, per steradian, by connecting every vertex to ``wo``.

    ``wi`` and ``wo`` broadcast to ``(..., 3)``, each pair takes ``walks`` walks of its own. Bounce
    1 is exact, with variance 0, if facets are smooth. The values are densities of energy. Radiance
    takes another factor across a dielectric (materials.py). Other arguments and errors as in
    `energies`; ``ValueError`` also for a dielectric of IOR 1.
    """
    wi, wo = pairs(wi, wo, surface)
    flat, target = wi.reshape(-1, 3), wo.reshape(-1, 3)
    rng = generator(rng)
    moments = Moments(max_bounces, flat.shape[0], walks, surface)
    exact = surface.material.smooth
    for rows, each in batches(flat.shape[0], walks):
        moments.start(rows, each)
        start = np.repeat(flat[rows], each, axis=0)
        for k, step in enumerate(bounces(start, surface, max_bounces, rng, roulette)):
            if k > 0 or not exact:
                pair = rows.start + step.walk // each
                moments.add(k, step.walk, connection(step, target[pair], surface))
        moments.finish(step if k == max_bounces - 1 else None)
    if exact:
        moments.mean[0] = first_bounce(flat, target, surface)[:, : moments.channels]
    return moments.result(wi.shape[:-1])


def lobe(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
    roulette: float = ROULETTE,
) -> Bounces:
    """BSDF times |cos(wo)| of one ``wi`` ``(3,)`` against many ``wo`` ``(..., 3)``, per steradian.

    All ``wo`` share the same walks, so the error is smooth over the lobe. A thousand directions
    cost little more than their connections. Otherwise as `evaluate`.
    """
    transmits = surface.material.transmits
    wi, wo = outside(wi, "wi", transmits), outside(wo, "wo", transmits)
    if wi.shape != (3,):
        raise ValueError(f"wi has shape {wi.shape}; a lobe belongs to one direction, shape (3,)")
    target = wo.reshape(-1, 3)
    rng = generator(rng)
    moments = Moments(max_bounces, target.shape[0], walks, surface)
    exact = surface.material.smooth
    for _, each in batches(1, walks):
        steps = list(bounces(np.broadcast_to(wi, (each, 3)), surface, max_bounces, rng, roulette))
        for j, one in enumerate(target):
            moments.start(slice(j, j + 1), each)
            for k, step in enumerate(steps):
                if k > 0 or not exact:
                    moments.add(k, step.walk, connection(step, one, surface))
            moments.finish(steps[-1] if len(steps) == max_bounces else None)
    if exact:
        moments.mean[0] = first_bounce(wi, target, surface)[:, : moments.channels]
    return moments.result(wo.shape[:-1])


def batches(directions: int, walks: int) -> Iterator[tuple[slice, int]]:
    """Slices of directions and numbers of walks whose product stays near the batch size."""
    group = max(1, _BATCH // walks)
    for first in range(0, directions, group):
        left = walks
        while left > 0:
            yield slice(first, min(first + group, directions)), min(left, _BATCH)
            left -= _BATCH


class Moments:
    """Sums up means, and variances of the mean, per bounce and direction, batch by batch."""

    def __init__(self, max_bounces: int, directions: int, walks: int, surface: Surface) -> None:
        max_bounces = count(max_bounces, "max_bounces", 1)
        self.walks = count(walks, "walks", 2)  # one walk alone has no variance
        self.channels = surface.material.channels
        self.mean = np.zeros((max_bounces, directions, self.channels))
        self.square = np.zeros_like(self.mean)
        self.total = np.zeros((directions, self.channels))
        self.total_square = np.zeros_like(self.total)
        self.remaining = np.zeros_like(self.total)

    def start(self, pairs: slice, count: int) -> None:
        """Begin a batch of ``count`` walks for each direction of ``pairs``."""
        self.pairs, self.count = pairs, count
        self.sums = np.zeros((pairs.stop - pairs.start, count, self.channels))

    def add(self, bounce: int, walk: np.ndarray, value: np.ndarray) -> None:
        """Add values ``(n, C)`` of one bounce, of the walks numbered ``walk`` ``(n,)``."""
        self.sums.reshape(-1, self.channels)[walk] += value
        self.mean[bounce, self.pairs] += self._per_direction(walk, value)
        self.square[bounce, self.pairs] += self._per_direction(walk, value * value)

    def finish(self, cut_off: Vertex | None = None) -> None:
        """End the batch; ``cut_off`` is the last vertex if `max_bounces` ended walks."""
        self.total[self.pairs] += self.sums.sum(axis=1) / self.walks
        self.total_square[self.pairs] += (self.sums * self.sums).sum(axis=1) / self.walks
        if cut_off is not None:
            self.remaining[self.pairs] += self._per_direction(cut_off.walk, cut_off.staying)

    def _per_direction(self, walk: np.ndarray, value: np.ndarray) -> np.ndarray:
        """Sum of ``value`` ``(n, C)`` over each direction's walks, divided by all its walks."""
        size = self.sums.shape[0]
        direction = walk // self.count
        full = np.broadcast_to(value, (walk.size, self.channels))
        sums = [np.bincount(direction, channel, size) for channel in full.T]
        return np.stack(sums, axis=-1) / self.walks

    def result(self, shape: tuple[int, ...]) -> Bounces:
        """The results, with directions reshaped to ``shape`` and three channels."""

        def rgb(values: np.ndarray, *leading: int) -> np.ndarray:
            return np.broadcast_to(values, (*values.shape[:-1], 3)).reshape(*leading, *shape, 3)

        def variance_of_mean(square: np.ndarray, mean: np.ndarray) -> np.ndarray:
            return np.maximum(square - mean * mean, 0.0) / (self.walks - 1)

        variance = variance_of_mean(self.square, self.mean)
        total_variance = variance_of_mean(self.total_square, self.total)
        rows = self.mean.shape[0]
        return Bounces(
            rgb(self.mean, rows), rgb(variance, rows), rgb(total_variance), rgb(self.remaining)
        )
