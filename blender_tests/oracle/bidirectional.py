# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the BSDF by bidirectional path sampling, beside the walk of `estimate.evaluate`.

For a path of k bounces, s vertices are drawn from wi, k - 1 - s from wo, and one vertex connects
them. All k ways to divide it (s = 0 .. k - 1) are combined by multiple importance sampling with the
balance heuristic (Veach 1997): each sample counts its contribution over the sum of the densities
with which all ways would have drawn the same path. s = k - 1 alone is the one-way walk. That one
never finds some narrow peaks, such as those of a dielectric of IOR near 1 (test_bidirectional.py).
"""

from collections.abc import Iterator

import numpy as np
from scipy.special import logsumexp

from .estimate import Bounces, Moments, batches
from .path import Path, Terms, log_contribution, random_paths, terms
from .surface import Surface
from .vectors import outside, to_side
from .visible import sample
from .walk import first_bounce


def evaluate(
    wi: np.ndarray,
    wo: np.ndarray,
    surface: Surface,
    max_bounces: int = 16,
    walks: int = 10_000,
    rng: np.random.Generator | int = 0,
) -> Bounces:
    """BSDF times |cos(wo)| at each bounce, per steradian; the same as `estimate.evaluate`.

    ``walks`` pairs of walks, one from each end, for each pair of directions. Errors as there, and
    ``ValueError`` for the height-tracked model, whose paths cannot be joined by directions alone.
    ``remaining`` is not estimated: nan.
    """
    transmits = surface.material.transmits
    wi, wo = np.broadcast_arrays(outside(wi, "wi", transmits), outside(wo, "wo", transmits))
    flat, target = wi.reshape(-1, 3), wo.reshape(-1, 3)
    rng = np.random.default_rng(rng)
    moments = Moments(max_bounces, flat.shape[0], walks, surface)
    exact = surface.material.smooth
    for pairs, count in batches(flat.shape[0], walks):
        moments.start(pairs, count)
        start, end = (np.repeat(w[pairs], count, axis=0) for w in (flat, target))
        from_wi, from_wo = (random_paths(w, surface, max_bounces, rng) for w in (start, end))
        walk = np.arange(start.shape[0])
        for k, value in enumerate(_values(start, end, from_wi, from_wo, surface, rng)):
            if k > 0 or not exact:
                moments.add(k, walk, value)
        moments.finish()
    if exact:
        moments.mean[0] = first_bounce(flat, target, surface)[:, : moments.channels]
    moments.remaining[:] = np.nan
    return moments.result(wi.shape[:-1])


def _values(
    start: np.ndarray,
    end: np.ndarray,
    from_wi: Path,
    from_wo: Path,
    surface: Surface,
    rng: np.random.Generator,
) -> Iterator[np.ndarray]:
    """Estimates of bounce 1, 2, ... from one pair of walks each, ``(n, C)``."""
    longest = from_wi.v.shape[0]
    near = terms(from_wi, surface)
    far = terms(from_wo.reversed(), surface)
    for k in range(1, longest + 1):
        value = 0.0
        for s in range(k):
            t = k - 1 - s
            v, below = to_side(start) if s == 0 else _onwards(from_wi, s - 1)
            o, o_below = to_side(end) if t == 0 else _onwards(from_wo, t - 1)
            m = v if surface.material.smooth else sample(v, surface, rng)
            middle = Path(v[None], o[None], m[None], below[None], (below ^ o_below)[None])
            whole = Terms.joined(near[:s], terms(middle, surface), far[longest - t :])
            value = value + _combined(whole)
        yield value


def _onwards(path: Path, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the vertex after ``last`` receives the paths from, and on which side."""
    return -path.o[last], path.below[last] ^ path.crossed[last]


def _combined(whole: Terms) -> np.ndarray:
    """Contribution of paths over the summed densities of all ways to draw them, ``(n, C)``."""
    nothing = np.zeros((1, *whole.turn.shape[1:]))
    before = np.cumsum(np.concatenate([nothing, whole.forward[:-1]]), axis=0)
    after = np.cumsum(np.concatenate([nothing, whole.backward[:0:-1]]), axis=0)[::-1]
    log_density = logsumexp(before + whole.facet + after, axis=0)
    log_value = log_contribution(whole)
    # what cannot be drawn in any way contributes nothing either
    log_density = np.where(np.isneginf(log_value), 0.0, log_density)
    return np.exp(log_value - log_density)[:, None] * whole.weight.prod(axis=0)
