# SPDX-License-Identifier: GPL-3.0-or-later
"""The further bounces of a rough metal as two closures, for conductor_lobes.h.

Bounce 2 and the later bounces each have a ramp about the normal. They share a microfacet lobe whose
mirror direction lies lower or higher than the view's. The less energy is left for later bounces,
the more of bounce 2 goes there.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, minimize

from osl.oracle import BECKMANN, CORRELATED, GGX, Conductor, Surface, energies
from osl.oracle.masking import exit_odds
from osl.oracle.ndf import D, sigma
from osl.oracle.quadrature import visible_normals

from . import grid, header
from .closures import KNOTS, diffuse_ramp, microfacet, normalized
from .fitting import BOUNCES, EXITS, SEED, WALKS, fit, orders, share_above, view
from .run import Run

ALPHAS = COSINES = 12  # nodes of the shapes
ENERGY_NODES = 32  # of the energies, along each axis

# Limits of the microfacet lobe's shape: sine of the mirror direction over the view's, and both
# alphas over the surface's.
LOWEST = (0.0, 0.3, 0.3)
HIGHEST = (3.0, 3.0, 3.0)
START = {False: (1.0, 1.05, 1.05), True: (1.0, 0.6, 0.6)}  # GGX, Beckmann
FARTHEST = 0.997  # sine of a mirror direction
# A step of these parameters by 1 must gain this much squared error. So they are smooth where they
# hardly matter.
INERTIA = 3e-6
# The cost of that lobe's energy, as a root of squared error. It makes a ramp win if it does as
# well.
RELUCTANCE = 0.1

LAYOUT = (
    ("RAMP_2", "knots of the ramp in bounce 2", KNOTS),
    ("RAMP_LATER", "knots of the ramp in later bounces", KNOTS),
    ("LOBE_2", "weight of the microfacet lobe in bounce 2", 1),
    ("LOBE_LATER", "its weight in later bounces", 1),
    ("LOBE_ENERGY", "its energy", 1),
    ("LOBE_SINE", "sine of its mirror direction over the view's", 1),
    ("LOBE_ALONG", "its alpha in the plane of incidence over the surface's", 1),
    ("LOBE_ACROSS", "its alpha across that plane over the surface's", 1),
)
COLOUR_LAYOUT = (
    ("SHARE_2", "energy of bounce 2 over that of all above 1", 1),
    ("FRESNEL_2", "cosine at which Fresnel is its mean in bounce 2", 1),
    ("FRESNEL_LATER", "cosine at which Fresnel is its mean in later bounces", 1),
    ("REST", "energy of bounces above 3 over that of all above 2", 1),
    ("RAMP_PART", "part of the energy in the ramps", 1),
)
SHAPES, COLOURS = header.width(LAYOUT), header.width(COLOUR_LAYOUT)
VALUES = SHAPES + COLOURS
SHAPE = slice(2 * KNOTS + 3, 2 * KNOTS + 6)  # of the microfacet lobe


def missing_energy(surface: Surface, cosine: float) -> float:
    """Energy of all further bounces between white mirrors: 1 minus that of the first bounce."""
    wi = view(cosine)
    m, weight = visible_normals(wi, surface, 80)
    c = np.maximum(m @ wi, 0.0)
    density = c * D(m, surface) * weight
    o = 2.0 * c[:, None] * m - wi
    v = np.broadcast_to(wi, o.shape)
    never = np.zeros(len(o), dtype=bool)
    odds = exit_odds(v, sigma(v, surface), o, sigma(-o, surface), never, None, CORRELATED)
    return float((density * odds.p_stay).sum() / density.sum())


def energy_row(distribution: str, index: int) -> list[float]:
    """`missing_energy` at the nodes of one alpha."""
    alpha = grid.alphas(ENERGY_NODES)[index]
    surface = Surface(alpha, alpha, distribution)
    return [missing_energy(surface, cosine) for cosine in grid.cosines(alpha, ENERGY_NODES)]


def mirror_normal(wi: np.ndarray, ratio: float) -> np.ndarray:
    """The normal whose mirror direction has the sine of the view's times ``ratio``."""
    x = -min(ratio * wi[0], FARTHEST)
    return normalized(wi + np.array([x, 0.0, np.sqrt(1.0 - x * x)]))


def microfacet_lobe(
    o: np.ndarray, wi: np.ndarray, surface: Surface, shape: np.ndarray
) -> np.ndarray:
    """The microfacet lobe of weight 1, ``(n,)``, of shape (ratio, alphas over the surface's)."""
    alpha = tuple(min(float(k) * surface.alpha_x, 1.0) for k in shape[1:])
    normal = mirror_normal(wi, shape[0])
    return microfacet(o, wi, normal, alpha, surface.distribution == BECKMANN)


def node(surface: Surface, cosine: float, start: np.ndarray) -> tuple[np.ndarray, float]:
    """The values of one node ``(VALUES,)`` and the fit's error, as image L2 over the hemisphere,
    relative to all bounces. ``start``: a neighbour's shape of the microfacet lobe."""
    wi = view(cosine)
    bounces = orders(surface, wi)
    scale = float(EXITS.energy(bounces.sum(axis=0) ** 2))
    ramp = diffuse_ramp(EXITS.o, np.array([0.0, 0.0, 1.0]))

    def with_lobe(shape: np.ndarray) -> np.ndarray:
        return np.column_stack([ramp, microfacet_lobe(EXITS.o, wi, surface, shape)])

    def cost(shape: np.ndarray) -> float:
        legal = np.clip(shape, LOWEST, HIGHEST)
        inertia = INERTIA * float(((legal - start) ** 2).sum()) + float(
            ((legal - shape) ** 2).sum()
        )
        return fit(with_lobe(legal), bounces[1], scale, reluctance=RELUCTANCE)[1] + inertia

    # There is no plane of incidence along the normal, so both alphas are the same.
    steps = np.diag([-0.2, 0.15, 0.15]) if cosine < 1.0 else np.array([[0.0, 0.15, 0.15]])
    best = minimize(
        lambda x: cost(start + x @ steps),
        np.zeros(len(steps)),
        method="Nelder-Mead",
        options={
            "maxfev": 120,
            "initial_simplex": np.eye(len(steps) + 1, len(steps), -1),
            "xatol": 5e-3,
            "fatol": 1e-8,
        },
    )
    shape = np.clip(start + best.x @ steps, LOWEST, HIGHEST)
    columns = with_lobe(shape)
    second, _ = fit(columns, bounces[1], scale, reluctance=RELUCTANCE)
    later, _ = fit(columns, bounces[2] + bounces[3], scale, reluctance=RELUCTANCE)
    missed = columns @ (second + later) - bounces[1:].sum(axis=0)
    energy = EXITS.energy(columns)
    ramps = energy[:KNOTS] @ (second + later)[:KNOTS]
    aimed = energy[KNOTS] * (second + later)[KNOTS]
    values = [*second[:KNOTS], *later[:KNOTS], second[KNOTS], later[KNOTS], energy[KNOTS], *shape]
    values += [*colour(surface, wi, bounces), 1.0 - share_above(ramps, aimed)]
    return np.array(values), float(np.sqrt(EXITS.energy(missed**2) / scale))


def colour(surface: Surface, wi: np.ndarray, bounces: np.ndarray) -> list[float]:
    """The first values of COLOUR_LAYOUT, by the lobes of ``bounces`` ``(4, n)``."""
    energy = EXITS.energy(bounces.T)
    second = 1.0 - share_above(energy[1], energy[2:].sum())
    return [second, *fresnel_cosines(surface, wi), share_above(*energy[2:])]


def fresnel_cosines(surface: Surface, wi: np.ndarray) -> tuple[float, float]:
    """The cosines at which Schlick's Fresnel factor of 1/2 is its mean over bounce 2 and over
    further ones.

    Further bounces of Fresnel factor F have the energy of white ones times F^3 (1 - rho) / (1 - rho
    F), as if each bounce left the same part rho.
    """

    def half(cosine: np.ndarray) -> np.ndarray:
        white = np.ones_like(cosine)
        return np.stack([white, 0.5 + 0.5 * (1.0 - cosine) ** 5, white], axis=-1)

    metal = replace(surface, material=Conductor(half))
    mean = energies(wi, metal, BOUNCES, WALKS, SEED, roulette=1e-3).both.mean
    white2, half2 = mean[1, :2]
    white3, half3 = mean[2:, :2].sum(axis=0)
    rho = share_above(mean[2, 0], white3 - mean[2, 0])
    factor2 = np.sqrt(half2 / white2) if white2 > 0.0 else 0.5
    wanted = half3 / white3 if white3 > 0.0 else 0.125
    factor3 = brentq(lambda f: f**3 * (1.0 - rho) / (1.0 - rho * f) - wanted, 0.0, 1.0)
    return tuple(1.0 - max(2.0 * f - 1.0, 0.0) ** 0.2 for f in (factor2, factor3))


def column(distribution: str, index: int) -> tuple[np.ndarray, np.ndarray]:
    """All nodes of one column of the table, ``(ALPHAS, VALUES)``, and their errors ``(ALPHAS,)``.

    They go from rough to smooth, and each fit starts from the shape before. A mirror takes the
    shapes of its neighbour, because only their proportions matter.
    """
    values, errors = np.zeros((ALPHAS, VALUES)), np.zeros(ALPHAS)
    start = np.array(START[distribution == BECKMANN])
    for i, alpha in reversed(list(enumerate(grid.alphas(ALPHAS)))[1:]):
        cosine = grid.cosines(alpha, COSINES)[index]
        values[i], errors[i] = node(Surface(alpha, alpha, distribution), cosine, start)
        start = values[i, SHAPE]
    values[0], errors[0] = values[1], errors[1]
    return values, errors


def tables(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shapes ``(2, ALPHAS, COSINES, VALUES)`` and energies ``(2, ENERGY_NODES, ENERGY_NODES, 1)``
    of GGX and Beckmann, and the errors of the fits ``(2, ALPHAS, COSINES)``."""
    columns = [(d, j) for d in (GGX, BECKMANN) for j in range(COSINES)]
    found = run(column, columns, "metal, shapes")
    values = np.array([one[0] for one in found]).reshape(2, COSINES, ALPHAS, VALUES)
    errors = np.array([one[1] for one in found]).reshape(2, COSINES, ALPHAS)
    rows = [(d, i) for d in (GGX, BECKMANN) for i in range(ENERGY_NODES)]
    energy = np.array(run(energy_row, rows, "metal, energies"))
    energy = energy.reshape(2, ENERGY_NODES, ENERGY_NODES, 1)
    return values.transpose(0, 2, 1, 3), energy, errors.transpose(0, 2, 1)


def body(run: Run) -> tuple[list[str], str]:
    """The header's own description, and its functions."""
    shapes, energy, errors = tables(run)
    parts = [
        header.function(
            "conductor_shape", header.columns("White metal:", "METAL", LAYOUT), shapes[..., :SHAPES]
        ),
        header.function(
            "conductor_colour",
            header.columns("Its further bounces:", "METAL", COLOUR_LAYOUT),
            shapes[..., SHAPES:],
        ),
        header.function("conductor_energy", "// Energy of bounces 2 and above.", energy),
    ]
    return header.provenance(SEED, WALKS, errors), "\n".join(parts)
