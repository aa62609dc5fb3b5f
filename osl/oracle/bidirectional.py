# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the BSDF by bidirectional path sampling, beside the walk of `estimate.evaluate`.

A path of k bounces has s vertices drawn from wi, k - 1 - s drawn from wo, and one that joins them.
Multiple importance sampling combines all k ways to divide it (s = 0 .. k - 1), by the balance
heuristic (Veach 1997). A sample is its contribution over the summed densities with which all ways
would have drawn the same path. s = k - 1 alone is the one-way walk. It misses some narrow peaks,
such as those of a dielectric of IOR near 1 (test_bidirectional.py).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from .checks import generator
from .estimate import Bounces, Moments, batches
from .path import Path, Terms, log_contribution, random_paths, terms
from .surface import Surface
from .vectors import to_side
from .visible import sample
from .walk import first_bounce, pairs


def evaluate(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
) -> Bounces:
    """BSDF times |cos(wo)| at each bounce, per steradian; the same as `estimate.evaluate`.

    Each pair of directions takes ``walks`` pairs of walks, one from each end. ``remaining`` is nan:
    it is not estimated. Raises the errors of `estimate.evaluate`, and ``ValueError`` for the
    height-tracked model, because directions alone cannot join its paths.
    """
    wi, wo = pairs(wi, wo, surface)
    flat, target = wi.reshape(-1, 3), wo.reshape(-1, 3)
    rng = generator(rng)
    moments = Moments(max_bounces, flat.shape[0], walks, surface)
    exact = surface.material.smooth
    for rows, each in batches(flat.shape[0], walks):
        moments.start(rows, each)
        start, end = (np.repeat(w[rows], each, axis=0) for w in (flat, target))
        # the vertex that joins two walks belongs to neither
        near, far = (_Walks.start(w, surface, max_bounces - 1, rng) for w in (start, end))
        walk = np.arange(start.shape[0])
        for k in range(2 if exact else 1, max_bounces + 1):
            moments.add(k - 1, walk, _value(k, near, far, surface, rng))
        moments.finish()
    if exact:
        moments.mean[0] = first_bounce(flat, target, surface)[:, : moments.channels]
    moments.remaining[:] = np.nan
    return moments.result(wi.shape[:-1])


@dataclass(frozen=True)
class _Walks:
    """Walks from one ``end`` ``(n, 3)``, with the terms of their vertices in walking order."""

    end: np.ndarray
    path: Path
    forward: Terms
    backward: Terms

    @classmethod
    def start(
        cls, end: np.ndarray, surface: Surface, vertices: int, rng: np.random.Generator
    ) -> "_Walks":
        """Draw ``vertices`` of each walk."""
        path = random_paths(end, surface, vertices, rng)
        return cls(end, path, terms(path, surface), terms(path.reversed(), surface)[::-1])

    def after(self, vertices: int) -> tuple[np.ndarray, np.ndarray]:
        """The next vertex's ``v`` and ``below`` after this many ``vertices``."""
        if vertices == 0:
            return to_side(self.end)
        last = vertices - 1
        return -self.path.o[last], self.path.below[last] ^ self.path.crossed[last]


def _value(
    k: int, near: _Walks, far: _Walks, surface: Surface, rng: np.random.Generator
) -> np.ndarray:
    """Estimates of bounce ``k`` from one pair of walks each, ``(n, C)``."""
    value = 0.0
    for s in range(k):
        t = k - 1 - s
        (v, below), (o, o_below) = near.after(s), far.after(t)
        m = v if surface.material.smooth else sample(v, surface, rng)
        joint = Path(v[None], o[None], m[None], below[None], (below ^ o_below)[None])
        rest = far.backward[:t][::-1]
        value = value + _combined(Terms.joined(near.forward[:s], terms(joint, surface), rest))
    return value


def _combined(whole: Terms) -> np.ndarray:
    """Contribution of paths over the summed densities of all ways to draw them, ``(n, C)``."""
    nothing = np.zeros((1, *whole.turn.shape[1:]))
    before = np.cumsum(np.concatenate([nothing, whole.forward[:-1]]), axis=0)
    after = np.cumsum(np.concatenate([nothing, whole.backward[:0:-1]]), axis=0)[::-1]
    log_density = logsumexp(before + whole.facet + after, axis=0)
    log_value = log_contribution(whole)
    # a path that no way can draw contributes nothing either
    log_density = np.where(np.isneginf(log_value), 0.0, log_density)
    return np.exp(log_value - log_density)[:, None] * whole.weight.prod(axis=0)
