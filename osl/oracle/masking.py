# SPDX-License-Identifier: GPL-3.0-or-later
"""Masking and shadowing on the full sphere, and the chance to leave that follows from them.

G1 stands for the paper's G1dist, and so on. ``v`` is on either side of the horizon; ``o.z > 0``:

    G1(v) = |1 / (1 + Lambda(v))| = |v.z| / sigma(v)                                       eq. 3
    G2(v, o) = 1 / (|Lambda(-v)| + Lambda(o)), with 1 + Lambda(v) for |Lambda(-v)|         eq. 12
             = |v.z| o.z / (sigma(v) o.z + sigma(-o) |v.z|)
    G2 of a middle bounce = G1(v) - G2(v, o), and G1(v) below the horizon                  eq. 17

G1(v) is the chance to arrive at all, so a path that has arrived leaves with p_exit = G2 / G1. The
sign printed in the first case of eq. 12 only makes sense as 1 + Lambda(wi), which is used here.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import betaln, digamma

from .ndf import sigma
from .surface import CORRELATED, UNCORRELATED, Surface
from .vectors import unit_vectors


class ExitOdds(NamedTuple):
    """Chances ``(...)`` to leave and to stay; both keep all digits."""

    p_exit: np.ndarray
    p_stay: np.ndarray


def G1(w: np.ndarray, surface: Surface) -> np.ndarray:
    """Spherical distant masking (eq. 3), ``(...)``; exceeds 1 below the horizon, and is infinite
    if no facet is visible from ``w``. ``ValueError`` for a ``w`` that is not a unit vector."""
    w = unit_vectors(w, "w")
    area = sigma(w, surface)
    seen = area > 0.0
    return np.where(seen, np.abs(w[..., 2]) / np.where(seen, area, 1.0), np.inf)


def G2(v: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """Height-correlated masking and shadowing of a last bounce (eqs. 12-13), ``(...)``.

    ``v`` on either side of the horizon; 0 if ``o.z <= 0``. Infinite if neither v nor -o sees a
    facet. ``ValueError`` for directions that are not unit vectors.
    """
    v, o = unit_vectors(v, "v"), unit_vectors(o, "o")
    cos_v, cos_o = np.abs(v[..., 2]), np.maximum(o[..., 2], 0.0)
    # G1 p_exit would be infinity times 0 if no facet is visible from v alone
    both = sigma(v, surface) * cos_o + sigma(-o, surface) * cos_v
    seen = both > 0.0
    unseen = np.where(cos_v * cos_o > 0.0, np.inf, 0.0)
    return np.where(seen, cos_v * cos_o / np.where(seen, both, 1.0), unseen)


def G2_middle(v: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """Height-correlated chance to arrive from ``v`` and be blocked towards ``o`` (eqs. 14, 16-17),
    ``(...)``. ``ValueError`` for directions that are not unit vectors."""
    v, o = unit_vectors(v, "v"), unit_vectors(o, "o")
    return G1(v, surface) * _correlated(v, sigma(v, surface), o, sigma(-o, surface)).p_stay


def exit_probability(v: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """Height-correlated p_exit (eqs. 12, 14, 16-17) of a reflected path, shape ``(...)``.
    ``ValueError`` for directions that are not unit vectors."""
    v, o = unit_vectors(v, "v"), unit_vectors(o, "o")
    return _correlated(v, sigma(v, surface), o, sigma(-o, surface)).p_exit


def exit_odds(
    v: np.ndarray,
    area_v: np.ndarray,
    o: np.ndarray,
    area_back: np.ndarray,
    crossed: np.ndarray | None,
    log_u: np.ndarray | None,
    model: str,
) -> ExitOdds:
    """The chances of a path that came from ``v`` and turned to ``o``, each in its side's frame.

    ``area_v`` is sigma(v), ``area_back`` sigma(-o); ``crossed`` ``(...)`` tells whether the path
    changed sides on the way (None: nowhere). ``log_u`` is the logarithm of the height's
    distribution function on o's side. Only the height-tracked model needs it.
    """
    if model == UNCORRELATED:
        return _uncorrelated(o, area_back)
    if model == CORRELATED:
        odds = _correlated(v, area_v, o, area_back)
        if crossed is None or not np.any(crossed):
            return odds
        through = _correlated_crossed(v, area_v, o, area_back)
        return ExitOdds(*(np.where(crossed, t, r) for t, r in zip(through, odds, strict=True)))
    return _height_tracked(o, area_back, log_u)


def _correlated(
    v: np.ndarray, area_v: np.ndarray, o: np.ndarray, area_back: np.ndarray
) -> ExitOdds:
    """p_exit = sigma(v) o.z / (sigma(v) o.z + sigma(-o) |v.z|)   (eqs. 12, 14, 16-17)."""
    leave = area_v * np.maximum(o[..., 2], 0.0)
    stay = area_back * np.abs(v[..., 2])
    both = leave + stay
    # Both vanish only if no micronormal is visible from v; such paths carry no weight.
    safe = np.where(both > 0.0, both, 1.0)
    up = o[..., 2] > 0.0
    return ExitOdds(np.where(up, leave / safe, 0.0), np.where(up, stay / safe, 1.0))


def _correlated_crossed(
    v: np.ndarray, area_v: np.ndarray, o: np.ndarray, area_back: np.ndarray
) -> ExitOdds:
    """p_exit = a B(a, 1 + Lambda(o)), a = |1 + Lambda(v)|: eq. 15 for a path that goes through.

    Arriving paths see heights whose distribution function u has density a u^(a-1). They leave on
    the other side with the chance (1 - u)^Lambda(o). The mean is Gamma(1 + a) Gamma(1 + Lambda) /
    Gamma(1 + a + Lambda), which is symmetric. The logarithms cancel if the smaller of both is
    small. Then the integral of psi(1 + x) - psi(1 + large + x) over x from 0 to small keeps the
    digits; psi is the digamma function.
    """
    up = o[..., 2] > 0.0
    # a v that sees no facet, sigma(v) = 0, carries no weight; the floor avoids 0 * infinity
    a = np.maximum(_ratio(area_v, np.abs(v[..., 2])), 1e-300)
    big_lambda = np.where(up, _ratio(area_back, np.maximum(o[..., 2], 0.0)), 1.0)
    log_exit = np.asarray(np.minimum(np.log(a) + betaln(a, 1.0 + big_lambda), 0.0))
    small, large = np.minimum(a, big_lambda), 1.0 + np.maximum(a, big_lambda)
    tiny = small < 1e-2
    s, t = small[tiny], large[tiny]
    # Gauss's rule of two points; its relative error is about small^4 / 200
    nodes = (s * (0.5 - np.sqrt(1.0 / 12.0)), s * (0.5 + np.sqrt(1.0 / 12.0)))
    log_exit[tiny] = 0.5 * s * sum(digamma(1.0 + x) - digamma(t + x) for x in nodes)
    return ExitOdds(np.where(up, np.exp(log_exit), 0.0), np.where(up, -np.expm1(log_exit), 1.0))


def _uncorrelated(o: np.ndarray, area_back: np.ndarray) -> ExitOdds:
    """p_exit = G1(o) (eqs. 19-24), and 1 - G1(o) = sigma(-o) / sigma(o) above the horizon."""
    z = np.maximum(o[..., 2], 0.0)
    area = z + area_back  # sigma(o) for o.z > 0
    safe = np.where(area > 0.0, area, 1.0)
    up = z > 0.0
    return ExitOdds(np.where(up, z / safe, 0.0), np.where(up, area_back / safe, 1.0))


def _height_tracked(o: np.ndarray, area_back: np.ndarray, log_u: np.ndarray) -> ExitOdds:
    """p_exit = u^Lambda(o)   (Heitz et al. 2016)."""
    up = o[..., 2] > 0.0
    log_exit = log_u * np.where(up, _ratio(area_back, np.maximum(o[..., 2], 0.0)), 1.0)
    return ExitOdds(np.where(up, np.exp(log_exit), 0.0), np.where(up, -np.expm1(log_exit), 1.0))


def next_height(
    log_u: np.ndarray, o: np.ndarray, area_back: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """The height at which a path that stays, from ``log_u`` towards ``o``, meets the surface again.

    Heights are logarithms of their distribution function u on the path's side, ``(n,)``. Downwards
    u <- u U^(1/|Lambda|). Upwards u <- u / T^(1/Lambda), with T uniform between u^Lambda, the
    chance to escape, and 1 (Heitz et al. 2016). |Lambda| is sigma(-o) / |o.z|.
    """
    up = o[:, 2] > 0.0
    depth = np.abs(o[:, 2])
    draw = rng.random(log_u.size)
    p_stay = -np.expm1(log_u * _ratio(area_back, depth))
    rise = np.where(up, -np.log1p(-draw * p_stay), np.log1p(-draw))
    return np.minimum(log_u + _ratio(depth, area_back) * rise, 0.0)


def first_height(v: np.ndarray, area_v: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """log(u) of the first vertex of paths from ``v`` above the surface, ``(n,)``.

    u has density a u^(a-1), a = 1 + Lambda(v) (eq. 15). That is `next_height` downwards from the
    top, u = 1.
    """
    return next_height(np.zeros(area_v.shape), -v, area_v, rng)


def height_from_below(log_u: np.ndarray) -> np.ndarray:
    """log(1 - u) from log(u) ``(n,)``: the same height seen from the surface's other side."""
    near_top = np.log(np.maximum(-np.expm1(log_u), 1e-300))
    return np.where(log_u > -1.0, near_top, np.log1p(-np.exp(np.minimum(log_u, -1.0))))


def _ratio(numerator: np.ndarray, denominator: np.ndarray) -> np.ndarray:
    """A quotient of numbers >= 0, at most 1e15, which stands for infinity.

    |Lambda| is infinite for a horizontal direction, and its inverse if no facet is visible.
    """
    finite = numerator < 1e15 * denominator
    return np.where(finite, numerator / np.where(finite, denominator, 1.0), 1e15)
