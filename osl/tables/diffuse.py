# SPDX-License-Identifier: GPL-3.0-or-later
"""All bounces of a rough matte surface as three closures, for diffuse_lobes.h.

A ramp about the normal, one about an axis tilted towards the viewer, and Oren and Nayar's lobe. The
first bounce is brightest towards the viewer and the second away from it, so the second may take
from what the first gives to a closure: with an albedo of at most 1, something is always left.
"""

import numpy as np

from osl.oracle import BECKMANN, CORRELATED, GGX, Diffuse, Surface

from . import grid, header
from .closures import KNOTS, diffuse_ramp, oren_nayar
from .fitting import EXITS, SEED, WALKS, fit, orders, share_above, view
from .run import Run

ALPHAS = COSINES = 12
TILT = 0.3  # rad, of the axis

LAYOUT = (
    ("knots about the normal, bounce 1", KNOTS),
    ("knots about the tilted axis", KNOTS),
    ("factor of Oren and Nayar's lobe", 1),
    ("the same of bounce 2", 2 * KNOTS + 1),
    ("of further bounces: knots about the normal", KNOTS),
    ("factor of Oren and Nayar's lobe", 1),
    ("energy of bounces above 3 over that of all above 2", 1),
)
VALUES = sum(count for _, count in LAYOUT)


def tilted_axis() -> np.ndarray:
    """The axis ``(3,)`` towards the viewer."""
    return np.array([np.sin(TILT), 0.0, np.cos(TILT)])


def node(surface: Surface, cosine: float) -> tuple[np.ndarray, float]:
    """The values of one node ``(VALUES,)`` and the fit's error, as image L2 over the hemisphere,
    relative to all bounces of a white surface."""
    wi = view(cosine)
    bounces = orders(surface, wi)
    scale = float(EXITS.energy(bounces.sum(axis=0) ** 2))
    lobe = oren_nayar(EXITS.o, wi)[:, None]
    upright = diffuse_ramp(EXITS.o, np.array([0.0, 0.0, 1.0]))
    tilted = diffuse_ramp(EXITS.o, tilted_axis())
    smooth = surface.alpha_x <= grid.SMALLEST_ALPHA
    if smooth or cosine == 1.0:
        tilted *= 0.0  # along the normal no direction is the viewer's side
    if smooth:
        lobe *= 0.0  # these nodes stand for all views, which a flat surface does not know
    columns = np.hstack([upright, tilted, lobe])
    first, _ = fit(columns, bounces[0], scale, ramps=2)
    later_columns = np.hstack([upright, lobe])
    later, _ = fit(later_columns, bounces[2] + bounces[3], scale)
    # What the first leaves to be desired the second makes good, at least on white surfaces.
    left = bounces.sum(axis=0) - columns @ first - later_columns @ later
    second, error = fit(columns, left, scale, ramps=2, lowest=-first)
    share = share_above(*EXITS.energy(bounces[2:].T))
    values = np.array([*first, *second, *later, share])
    return values, float(np.sqrt(error))


def row(distribution: str, index: int) -> tuple[np.ndarray, np.ndarray]:
    """The nodes of one alpha, ``(COSINES, VALUES)``, and their errors ``(COSINES,)``."""
    alpha = grid.alphas(ALPHAS)[index]
    surface = Surface(alpha, alpha, distribution, Diffuse(), CORRELATED)
    found = [node(surface, cosine) for cosine in grid.cosines(alpha, COSINES)]
    return np.array([one[0] for one in found]), np.array([one[1] for one in found])


def body(run: Run) -> tuple[list[str], str]:
    """What the header says about itself, and its functions."""
    rows = [(d, i) for d in (GGX, BECKMANN) for i in range(ALPHAS)]
    found = run(row, rows, "matte surfaces")
    values = np.array([one[0] for one in found]).reshape(2, ALPHAS, COSINES, VALUES)
    errors = np.array([one[1] for one in found])
    about = header.provenance(SEED, WALKS, errors)
    knots = EXITS.energy(diffuse_ramp(EXITS.o, tilted_axis()))
    parts = [
        header.constant("DIFFUSE_TILT", TILT),
        header.function("diffuse_shape", header.described("A white surface:", LAYOUT), values),
        header.array("tilted_knot_energy", "Energy of a knot of the tilted ramp.", knots),
    ]
    return about, "\n".join(parts)
