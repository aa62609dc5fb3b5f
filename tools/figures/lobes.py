# SPDX-License-Identifier: GPL-3.0-or-later
"""Where light leaves a surface: the directions of many exits, counted by bounce.

Every column of the figures goes through `gather`, whether its bounces come from a model's walk or
from rays on a simulated surface. The light comes from ``wi`` = (-sin theta, 0, cos theta), so that
a mirror sends it to psi = theta; psi = atan2(x, z) is the angle from the normal of a direction
projected on the plane of incidence.

The work is done in parts, whose scatter gives the standard errors. The result holds sums over the
parts of each value and of its square. So adding up merges results.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

BOUNCES = 8  # energies of bounces 1 to 7, and of 8 and more
LOBES = 5  # lobes of bounces 1 to 4, and of 5 and more
BOUNCE_NAMES = (*(str(k) for k in range(1, BOUNCES)), f"{BOUNCES}+")
LOBE_NAMES = (*(str(k) for k in range(1, LOBES)), f"{LOBES}+")
MAX_BOUNCES = 200  # for safety; "remaining" is the energy still inside after it

PLANE_BINS = 240  # bins of psi over -pi..pi; the horizon lies between two
PLANE_WIDTH = 2.0 * np.pi / PLANE_BINS
# Cells of equal solid angle: bands of z, times azimuths from 0 to pi, since all surfaces and lights
# are symmetric about the plane of incidence.
BANDS, AZIMUTHS = 32, 12
CELLS = BANDS * AZIMUTHS

Sums = dict[str, np.ndarray]


class Bounce(Protocol):
    """The part of `walk.Vertex` and `simulation.Hit` that is read here."""

    direction: np.ndarray
    below_after: np.ndarray
    leaving: np.ndarray
    staying: np.ndarray


@dataclass(frozen=True)
class Estimate:
    """A mean over parts and its standard error, of the same shape."""

    mean: np.ndarray
    error: np.ndarray


@dataclass(frozen=True)
class Lobes:
    """The exits of one surface, model and direction.

    ``energies`` ``(BOUNCES, 2)``, reflected and transmitted; ``total`` ``(2,)``, their sums over
    bounces; ``plane`` ``(LOBES, PLANE_BINS)``, energy per radian of psi. ``halves``
    ``(2, LOBES, CELLS)``: energy in each cell, found by one half of the parts and by the other.
    ``remaining`` and ``lost``: shares of the energy still inside after the last bounce, and of the
    rays that a simulation dropped.
    """

    energies: Estimate
    total: Estimate
    plane: Estimate
    halves: np.ndarray
    remaining: float
    lost: float

    @classmethod
    def merge(cls, *found: Sums) -> "Lobes":
        """The lobes from one result of `gather` or more."""
        total = {name: sum(sums[name] for sums in found) for name in found[0]}
        count = total["parts"]

        def estimate(name: str) -> Estimate:
            mean = total[name] / count
            variance = np.maximum(total[f"{name}_squared"] / count - mean * mean, 0.0)
            return Estimate(mean, np.sqrt(variance / (count - 1)))

        return cls(
            estimate("energies"),
            estimate("total"),
            estimate("plane"),
            total["halves"] / (0.5 * count),
            float(total["remaining"] / count),
            float(total["lost"] / count),
        )


def incident(theta: float) -> np.ndarray:
    """wi ``(3,)`` at the angle ``theta`` from the normal, on the side of negative x."""
    return np.array([-np.sin(theta), 0.0, np.cos(theta)])


def plane_angles() -> np.ndarray:
    """The middles of the bins of psi, ``(PLANE_BINS,)``."""
    return PLANE_WIDTH * (np.arange(PLANE_BINS) + 0.5) - np.pi


def by_lobe(energies: np.ndarray) -> np.ndarray:
    """Energies ``(BOUNCES, ...)`` by lobe ``(LOBES, ...)``; the last lobe takes the rest."""
    return np.concatenate([energies[: LOBES - 1], energies[LOBES - 1 :].sum(axis=0, keepdims=True)])


def gather(parts: Iterator[Iterable[Bounce]], count: int) -> Sums:
    """Count the exits of an even number of ``parts``, each the bounces of ``count`` walks.

    Only colour channel 0 is read: the surfaces are white.
    """
    sums: Sums = {"parts": np.array(0.0), "halves": np.zeros((2, LOBES, CELLS))}
    for number, part in enumerate(parts):
        energies = np.zeros((BOUNCES, 2))
        plane, cells = np.zeros((LOBES, PLANE_BINS)), np.zeros((LOBES, CELLS))
        remaining = lost = 0.0
        for k, bounce in enumerate(part):
            out = np.flatnonzero(bounce.leaving[:, 0] > 0.0)
            weight, direction = bounce.leaving[out, 0] / count, bounce.direction[out]
            energies[min(k, BOUNCES - 1)] += np.bincount(bounce.below_after[out], weight, 2)
            lobe = min(k, LOBES - 1)
            plane[lobe] += np.bincount(_plane_bin(direction), weight, PLANE_BINS) / PLANE_WIDTH
            cells[lobe] += np.bincount(_cell(direction), weight, CELLS)
            lost = getattr(bounce, "dropped", 0) / count
            if k == MAX_BOUNCES - 1:
                remaining = bounce.staying[:, 0].sum() / count
        for name, value in (
            ("energies", energies),
            ("total", energies.sum(axis=0)),
            ("plane", plane),
        ):
            sums[name] = sums.get(name, 0.0) + value
            sums[f"{name}_squared"] = sums.get(f"{name}_squared", 0.0) + value * value
        for name, value in (("remaining", remaining), ("lost", lost), ("parts", 1.0)):
            sums[name] = sums.get(name, 0.0) + np.array(value)
        sums["halves"][number % 2] += cells
    return sums


def _plane_bin(direction: np.ndarray) -> np.ndarray:
    return _bin(np.arctan2(direction[:, 0], direction[:, 2]) / np.pi, PLANE_BINS)


def _cell(direction: np.ndarray) -> np.ndarray:
    azimuth = np.abs(np.arctan2(direction[:, 1], direction[:, 0])) / np.pi
    return _bin(-direction[:, 2], BANDS) * AZIMUTHS + _bin(2.0 * azimuth - 1.0, AZIMUTHS)


def _bin(value: np.ndarray, bins: int) -> np.ndarray:
    """Number of the bin of ``value`` among equal ones over -1..1."""
    return np.clip((0.5 * bins * (value + 1.0)).astype(np.int64), 0, bins - 1)
