# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits closures to the light that walks find, by least squares over the hemisphere."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from osl.oracle import Surface, lobe

from .closures import KNOTS

BOUNCES = 48  # of GGX at alpha 1, less than 1e-9 of the energy is left after 32
WALKS = 1 << 15
SEED = 5

# The cost of a ramp's second differences, as a squared error relative to all bounces. It keeps the
# walks' noise from making ripples.
STIFFNESS = 1e-3


@dataclass(frozen=True)
class Exits:
    """A rule over half the hemisphere, y > 0: directions ``o`` ``(n, 3)`` and solid angles ``(n,)``
    of both halves together."""

    o: np.ndarray
    weight: np.ndarray

    def energy(self, values: np.ndarray) -> np.ndarray:
        """Integral of values times cosine ``(n, ...)`` over the hemisphere."""
        return np.tensordot(self.weight, values, axes=1)


def exits(count: int = 18) -> Exits:
    """Gauss' rule in the roots of z and of the azimuth from the forward direction. It is dense
    where smooth surfaces send light of grazing views: forward, along the horizon."""
    node, weight = np.polynomial.legendre.leggauss(count)
    root, weight = (node + 1.0) / 2.0, weight / 2.0
    square, weight = root * root, weight * 2.0 * root
    z, phi = np.repeat(square, count), np.pi * (1.0 - np.tile(square, count))
    radius = np.sqrt(1.0 - z * z)
    o = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    return Exits(o, np.outer(weight, 2.0 * np.pi * weight).ravel())


EXITS = exits()


def view(cosine: float) -> np.ndarray:
    """The direction to the viewer ``(3,)``, in the plane y = 0."""
    return np.array([np.sqrt(1.0 - cosine * cosine), 0.0, cosine])


def orders(surface: Surface, wi: np.ndarray) -> np.ndarray:
    """Bounces 1, 2, 3, and all later ones together, of white facets at EXITS ``(4, n)``."""
    found = lobe(wi, EXITS.o, surface, BOUNCES, WALKS, SEED).mean[..., 0]
    return np.stack([*found[:3], found[3:].sum(axis=0)])


def share_above(third: float, later: float) -> float:
    """Energy of bounces above 3 over that of all above 2."""
    return later / (third + later) if later > 0.0 else 0.0


def fit(
    columns: np.ndarray,
    wanted: np.ndarray,
    scale: float,
    ramps: int = 1,
    lowest: np.ndarray | float = 0.0,
    reluctance: float = 0.0,
) -> tuple[np.ndarray, float]:
    """Factors ``(m,)`` >= ``lowest`` of ``columns`` ``(n, m)``, and the squared error over
    ``scale``. The first ``ramps`` times KNOTS columns are ramps; the energies of the others cost
    ``reluctance`` times themselves squared.

    Ramps are 0 at the horizon, as light from a rough surface is. Cycles samples them by the cosine,
    so any other value over the cosine would have no bound.
    """
    root = np.sqrt(EXITS.weight / scale)
    rows = []
    for start in range(0, ramps * KNOTS, KNOTS):
        for knot in range(start, start + KNOTS - 2):
            row = np.zeros(columns.shape[1])
            row[knot : knot + 3] = STIFFNESS * np.array([1.0, -2.0, 1.0])
            rows.append(row)
    for one in range(ramps * KNOTS, columns.shape[1]):
        row = np.zeros(columns.shape[1])
        row[one] = reluctance * EXITS.energy(columns[:, one])
        rows.append(row)
    a = np.concatenate([columns * root[:, None], rows])
    a[:, 0 : ramps * KNOTS : KNOTS] = 0.0
    b = np.concatenate([wanted * root, np.zeros(len(rows))])
    lowest = np.broadcast_to(lowest, columns.shape[1:])
    found = lowest + nnls(a, b - a @ lowest)[0]
    return found, float((((columns @ found - wanted) * root) ** 2).sum())
