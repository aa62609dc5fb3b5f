# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks on anisotropic white metal from many views: where its further bounces send light."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from osl.oracle import BECKMANN, CORRELATED, Surface
from osl.oracle.masking import exit_odds
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import visible_normals
from osl.oracle.walk import bounces

from .closures import normalized
from .conductor import fresnel_cosines
from .fitting import BOUNCES, Exits, share_above

WALKS = 1 << 12  # a view
NARROWEST = 0.1  # aspect, alpha_y over alpha_x
RESOLVED = 0.003  # a rule resolves a view if its error of the first bounce's energy is below this


@dataclass(frozen=True)
class View:
    """A surface and the direction to its viewer ``(3,)``."""

    surface: Surface
    wi: np.ndarray

    @property
    def stretched(self) -> np.ndarray:
        """The view's horizontal part as a surface of alpha 1 sees it ``(2,)``."""
        return self.wi[:2] * [self.surface.alpha_x, self.surface.alpha_y]

    @property
    def upright(self) -> float:
        """1 along the normal, 0 along the horizon."""
        return float(self.wi[2] / (self.wi[2] + np.hypot(*self.stretched)))

    @property
    def place(self) -> np.ndarray:
        """The variables of the polynomials, -1 to 1, ``(4,)``; the last is 0 along the normal."""
        x, y = normalized(self.stretched) ** 2
        aspect = np.log(self.surface.alpha_y / self.surface.alpha_x) / -np.log(NARROWEST)
        alpha, c = self.surface.alpha_x, self.upright
        return np.array([2.0 * alpha - 1.0, 2.0 * aspect + 1.0, 2.0 * c - 1.0, (1.0 - c) * (x - y)])


def views(distribution: str, count: int, seed: int) -> list[View]:
    """Views that fill the range of surfaces and directions evenly, the same in every run."""
    found = []
    for a, b, x, y, kind in qmc.Sobol(5, seed=seed).random(count):
        alpha = 1.0 if a < 0.15 else 0.01 + 0.99 * (a - 0.15) / 0.85
        aspect = NARROWEST ** np.clip(1.3 * b - 0.15, 0.0, 1.0)
        if kind < 0.6:
            theta, phi = 0.02 + 1.53 * x, 0.5 * np.pi * y
        else:  # even in the stretched view
            c = 0.02 + 0.98 * x
            slope, phi = (1.0 - c) / c, 0.5 * np.pi * y
            slope = slope / alpha * np.array([np.cos(phi), np.sin(phi) / aspect])
            theta, phi = min(np.arctan(np.hypot(*slope)), 1.568), np.arctan2(slope[1], slope[0])
        wi = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        found.append(View(Surface(alpha, alpha * aspect, distribution), wi))
    return found


def exits(view: View, count: int = 32) -> Exits:
    """Gauss' rule over the hemisphere, in latitude from y and longitude about it, dense about the
    mirrored view where the surface is smooth."""
    x, y, z = view.wi
    node, weight = np.polynomial.legendre.leggauss(count)
    angles = []
    for middle, alpha in (
        (-np.arcsin(y), view.surface.alpha_y),
        (-np.arctan2(x, z), view.surface.alpha_x),
    ):
        width = np.clip(0.5 * alpha, 0.005, 0.3)
        low, high = (np.arcsinh((end - middle) / width) for end in (-0.5 * np.pi, 0.5 * np.pi))
        place = low + 0.5 * (node + 1.0) * (high - low)
        angle = np.clip(middle + width * np.sinh(place), -0.5 * np.pi, 0.5 * np.pi)
        angles.append((angle, 0.5 * weight * (high - low) * width * np.cosh(place)))
    (latitude, by_latitude), (longitude, by_longitude) = angles
    b, q = np.repeat(latitude, count), np.tile(longitude, count)
    o = np.stack([np.cos(b) * np.sin(q), np.sin(b), np.cos(b) * np.cos(q)], axis=-1)
    return Exits(o, np.outer(by_latitude * np.cos(latitude), by_longitude).ravel())


def missing_energy(view: View, count: int = 60) -> float:
    """Energy of all further bounces between white mirrors: 1 minus that of the first bounce."""
    wi, surface = view.wi, view.surface
    m, weight = visible_normals(wi, surface, count)
    c = np.maximum(m @ wi, 0.0)
    density = c * D(m, surface) * weight
    o = 2.0 * c[:, None] * m - wi
    v = np.broadcast_to(wi, o.shape)
    odds = exit_odds(v, sigma(v, surface), o, sigma(-o, surface), None, None, CORRELATED)
    return float((density * odds.p_stay).sum() / density.sum())


def turned(v: np.ndarray, area: np.ndarray, o: np.ndarray, surface: Surface) -> np.ndarray:
    """Density ``(n, m)`` of turning from each of ``v`` ``(n, 3)``, whose sigma is ``area``, to each
    of ``o`` ``(m, 3)`` and leaving: the oracle's turn_and_leave of mirrors, for many pairs."""
    shrink = np.array([1.0 / surface.alpha_x, 1.0 / surface.alpha_y])
    x, y, z = (v[:, None, i] + o[None, :, i] for i in range(3))
    seen = z > 0.0
    z2 = np.where(seen, z, 1.0) ** 2
    slope2 = (x * shrink[0]) ** 2 + (y * shrink[1]) ** 2
    length2 = 2.0 + 2.0 * (v @ o.T)
    if surface.distribution == BECKMANN:
        density = np.exp(-np.minimum(slope2 / z2, 700.0)) * (length2 / z2) ** 2
    else:
        density = (length2 / (slope2 + z2)) ** 2
    leave, stay = np.outer(area, o[:, 2]), np.outer(np.abs(v[:, 2]), sigma(-o, surface))
    norm = 4.0 * np.pi * surface.alpha_x * surface.alpha_y
    return np.where(seen, density * o[:, 2] / (norm * (leave + stay)), 0.0)


def first(view: View, o: np.ndarray) -> np.ndarray:
    """The first bounce of a white metal at ``o`` ``(n, 3)``: value times cosine, ``(n,)``."""
    v = view.wi[None]
    return turned(v, sigma(v, view.surface), o, view.surface)[0]


def further(
    view: View, o: np.ndarray, seed: int, walks: int = WALKS
) -> tuple[np.ndarray, np.ndarray]:
    """All further bounces of a white metal at ``o`` ``(n, 3)``, ``(n,)``, and the energy of each
    bounce ``(BOUNCES,)``."""
    surface, rng = view.surface, np.random.default_rng(seed)
    value, energy = np.zeros(len(o)), np.zeros(BOUNCES)
    start = np.broadcast_to(view.wi, (walks, 3))
    for k, step in enumerate(bounces(start, surface, BOUNCES, rng)):
        energy[k] = step.leaving.sum() / walks
        if k > 0:
            for i in range(0, len(step.v), 64):
                rows = slice(i, i + 64)
                seen = turned(step.v[rows], step.area[rows], o, surface)
                value += step.weight[rows, 0] @ seen / walks
    return value, energy


@dataclass(frozen=True)
class Sample:
    """The data of a view's fit: the further bounces' value ``(n,)`` at its exits, their ``energy``,
    the ``norm`` of all bounces as image L2, and the parameters of the ``colour`` ``(4,)``."""

    view: View
    value: np.ndarray
    energy: float
    norm: float
    colour: np.ndarray
    resolved: bool


def sampled(view: View, seed: int) -> Sample:
    """Walk from one view. The rule over exits resolves it if it finds the first bounce's energy."""
    rule = exits(view)
    value, found = further(view, rule.o, seed)
    energy, one = missing_energy(view), first(view, rule.o)
    value *= energy / max(found[1:].sum(), 1e-12)
    norm = float(np.sqrt(rule.energy((one + value) ** 2)))
    shares = found[1] / max(found[1:].sum(), 1e-12), share_above(found[2], found[3:].sum())
    colour = np.array([shares[0], *fresnel_cosines(view.surface, view.wi), shares[1]])
    resolved = abs(rule.energy(one) + energy - 1.0) < RESOLVED
    return Sample(view, value, energy, norm, colour, resolved)
