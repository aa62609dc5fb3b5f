# SPDX-License-Identifier: GPL-3.0-or-later
"""All bounces of a rough matte surface as three closures, for diffuse_lobes.h.

They are a ramp about the normal, a ramp about an axis tilted towards the viewer, and Oren and
Nayar's lobe. The first bounce is brightest towards the viewer, the second away from it. So the
second may subtract from what the first gives to a closure. With an albedo of at most 1, something
is always left.
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
    ("UPRIGHT_1", "knots of the ramp about the normal in bounce 1", KNOTS),
    ("TILTED_1", "knots of the ramp about the tilted axis in bounce 1", KNOTS),
    ("NAYAR_1", "factor of Oren and Nayar's lobe in bounce 1", 1),
    ("UPRIGHT_2", "knots of the ramp about the normal in bounce 2", KNOTS),
    ("TILTED_2", "knots of the ramp about the tilted axis in bounce 2", KNOTS),
    ("NAYAR_2", "factor of Oren and Nayar's lobe in bounce 2", 1),
    ("UPRIGHT_LATER", "knots of the ramp about the normal in later bounces", KNOTS),
    ("NAYAR_LATER", "factor of Oren and Nayar's lobe in later bounces", 1),
    ("REST", "energy of bounces above 3 over that of all above 2", 1),
)
VALUES = header.width(LAYOUT)


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
        tilted *= 0.0  # for a view along the normal, no side is the viewer's
    if smooth:
        lobe *= 0.0  # a flat surface looks the same from all views, and these nodes stand for all
    columns = np.hstack([upright, tilted, lobe])
    first, _ = fit(columns, bounces[0], scale, ramps=2)
    later_columns = np.hstack([upright, lobe])
    later, _ = fit(later_columns, bounces[2] + bounces[3], scale)
    # The second bounce corrects the fit of the first, at least on white surfaces.
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
    """The header's own description, and its functions."""
    rows = [(d, i) for d in (GGX, BECKMANN) for i in range(ALPHAS)]
    found = run(row, rows, "matte surfaces")
    values = np.array([one[0] for one in found]).reshape(2, ALPHAS, COSINES, VALUES)
    errors = np.array([one[1] for one in found])
    about = header.provenance(SEED, WALKS, errors)
    knots = EXITS.energy(diffuse_ramp(EXITS.o, tilted_axis()))
    parts = [
        header.constant("DIFFUSE_TILT", TILT),
        header.function("diffuse_shape", header.columns("White matte:", "MATTE", LAYOUT), values),
        header.array("tilted_knot_energy", "Energy of a knot of the tilted ramp.", knots),
    ]
    return about, "\n".join(parts)
