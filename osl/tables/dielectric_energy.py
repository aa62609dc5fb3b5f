# SPDX-License-Identifier: GPL-3.0-or-later
"""The energy that the first bounce of white glass leaves, and that Cycles' closure leaves."""

import numpy as np

from osl.oracle import BECKMANN, CORRELATED, GGX, Dielectric, Surface
from osl.oracle.fresnel import dielectric_reflectance
from osl.oracle.masking import exit_odds
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import visible_normals

from . import grid
from .closures import normalized
from .fitting import view
from .run import Run

LOWEST_INDEX, HIGHEST_INDEX = 1.05, 2.5
# Nodes from outside and inside: indices, alphas, cosines.
ENERGIES = {False: (7, 10, 10), True: (11, 12, 12)}


def indices(count: int, inside: bool) -> np.ndarray:
    """The nodes' index beyond the surface over the index before it, ``(count,)``."""
    ends = np.sqrt(np.log([LOWEST_INDEX, HIGHEST_INDEX]))
    index = np.exp(np.linspace(*ends, count) ** 2)
    return 1.0 / index if inside else index


def cycles_lambda(z: np.ndarray, alpha: float, beckmann: bool) -> np.ndarray:
    """Smith's Lambda for cosines ``z`` ``(n,)``; Beckmann's by Cycles' formula (Walter 2007)."""
    z = np.maximum(z, 1e-9)
    squared = alpha**2 * (1.0 - z * z) / (z * z)
    if not beckmann:
        return 0.5 * (np.sqrt(1.0 + squared) - 1.0)
    a = 1.0 / np.sqrt(np.maximum(squared, 1e-30))
    fitted = ((0.396 * a - 1.259) * a + 1.0) / ((2.181 * a + 3.535) * a)
    return np.where(squared < 0.39, 0.0, fitted)


def missing_energy(surface: Surface, cosine: float, count: int = 40) -> tuple[float, float]:
    """1 minus the energy of Cycles' glass as it is sampled, and 1 minus that of the first bounce;
    ``count``: points along each axis of the rule."""
    eta, alpha = surface.material.ior, surface.alpha_x
    wi = view(cosine)
    m, weight = visible_normals(wi, surface, count)
    c = np.clip(m @ wi, 0.0, 1.0)
    density = c * D(m, surface) * weight
    reflected = 2.0 * c[:, None] * m - wi
    beyond = np.sqrt(np.maximum(1.0 - (1.0 - c * c) / eta**2, 0.0))
    through = normalized(wi / eta + (beyond - c / eta)[:, None] * m)
    v, fresnel = np.broadcast_to(wi, m.shape), dielectric_reflectance(c, eta)
    beckmann = surface.distribution == BECKMANN
    here = 1.0 + cycles_lambda(np.array(cosine), alpha, beckmann)
    sampled, true = 0.0, 0.0
    for o, part, crossed in ((reflected, fresnel, False), (through, 1.0 - fresnel, True)):
        odds = exit_odds(
            v, sigma(v, surface), o, sigma(-o, surface), np.full(c.shape, crossed), None, CORRELATED
        )
        true += density * part * odds.p_exit
        seen = here / (here + cycles_lambda(o[:, 2], alpha, beckmann))
        sampled += density * part * np.where(o[:, 2] > 0.0, seen, 0.0)
    whole = density.sum()
    return tuple(float(1.0 - one.sum() / whole) for one in (sampled, true))


def energy_row(distribution: str, inside: bool, index: int, row: int) -> np.ndarray:
    """Roots of `missing_energy` ``(cosines, 2)`` at the nodes of one index and alpha."""
    count, alphas, cosines = ENERGIES[inside]
    eta, alpha = indices(count, inside)[index], grid.alphas(alphas)[row]
    surface = Surface(alpha, alpha, distribution, Dielectric(eta))
    missing = [missing_energy(surface, cosine) for cosine in grid.cosines(alpha, cosines)]
    return np.sqrt(np.maximum(missing, 0.0))


def energies(run: Run, inside: bool) -> np.ndarray:
    """Roots of `missing_energy` ``(2, *ENERGIES, 2)`` of GGX and Beckmann."""
    count, alphas, _ = ENERGIES[inside]
    wanted = [
        (distribution, inside, index, alpha)
        for distribution in (GGX, BECKMANN)
        for index in range(count)
        for alpha in range(alphas)
    ]
    found = run(energy_row, wanted, f"glass, energies {'inside' if inside else 'outside'}")
    return np.array(found).reshape(2, *ENERGIES[inside], 2)
