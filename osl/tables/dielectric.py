# SPDX-License-Identifier: GPL-3.0-or-later
"""The further bounces of rough glass as four closures, for dielectric_lobes.h.

Light that goes through has a lobe about a tilted axis, and a cosine about the normal. That lobe is
a refraction so steep that it follows its facets' normals whatever the view. Light that comes back
has a microfacet lobe about a tilted normal, and a cosine. Their energies are what Cycles' own
glass, or the true first bounce, leaves of white light.

Nodes are those of grid.py in alpha and in the view's cosine. In the index they are even in the root
of its logarithm, on either side of the surface. Tables hold the roots of energies, which are
straighter.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from osl.oracle import BECKMANN, GGX, Dielectric, Surface
from osl.oracle.ndf import D
from osl.oracle.quadrature import visible_normals
from osl.oracle.walk import bounces

from . import grid, header
from .closures import KNOTS, knots, microfacet
from .dielectric_energy import (
    HIGHEST_INDEX,
    LOWEST_INDEX,
    cycles_lambda,
    energies,
    indices,
)
from .fitting import BOUNCES, SEED, view
from .run import Run

WALKS = 1 << 17
SOURCES = ("dielectric_energy.py",)  # files that decide on the values, besides this one

# Nodes of the shapes: indices, alphas, cosines.
SHAPES = (4, 6, 7)

STEEP_INDEX = 1000.0
# Limits of the steep lobe's half-width (rad) and of the microfacet's alpha. Wider ones lose light.
NARROWEST, WIDEST = (0.12, 0.03), (0.9, 0.7)
# Knots of the ramp about the normal that has the rest of the light coming back.
PLATEAU = (0.0, 0.6, 0.85, 1.0, 0.85, 0.65, 0.55, 0.5)
STEEP_START = 0.25  # width over alpha
# A step by 1 in these parameters must gain this much squared error, relative to the fitted part. So
# they are smooth where they hardly matter.
INERTIA = 2e-3

LAYOUT = (
    ("ROOT_THINNER", "root of the further bounces' part that leaves into the lower index", 1),
    ("STEEP_PART", "part of what goes through in the steep lobe", 1),
    ("STEEP_ROOT", "root of that lobe's weight for an energy of 1", 1),
    ("STEEP_TILT", "angle of its axis from the normal", 1),
    ("STEEP_WIDTH", "its half-width", 1),
    ("MIRROR_PART", "part of what comes back in the microfacet lobe", 1),
    ("MIRROR_ROOT", "root of that lobe's weight for an energy of 1", 1),
    ("MIRROR_TILT", "angle of its normal", 1),
    ("MIRROR_ALPHA", "its alpha", 1),
    ("REST", "part of the light that each bounce after the first leaves for the next", 1),
)
VALUES = header.width(LAYOUT)
MISSING_LAYOUT = (
    ("ROOT_BEYOND_CYCLES", "root of what Cycles' glass, as sampled, leaves of white light", 1),
    ("ROOT_BEYOND_FIRST", "root of what the first bounce leaves", 1),
)

FUNCTION = """\
{comment}
void {name}(int distribution, {side}float alpha, float cosine, float ior,
{indent}output float values[{count}])
{{
  float table[{size}] = {{
{rows}
  }};
  Cube cube = table_cube(alpha, cosine, ior, LOWEST_INDEX, HIGHEST_INDEX, {alphas}, {cosines},
                         {indices}, {first});
  for (int i = 0; i < {count}; ++i) {{
    values[i] = 0;
    for (int c = 0; c < 6; ++c)
      values[i] += cube.weight[c] * table[cube.node[c] * {count} + i];
  }}
}}
"""


@dataclass(frozen=True)
class Bins:
    """Equal parts of the hemisphere y > 0: their centres ``o`` ``(n, 3)``."""

    rows: int = 24
    columns: int = 32

    @property
    def o(self) -> np.ndarray:
        """Row by row up from the horizon, each from the direction of x on."""
        z = np.repeat((np.arange(self.rows) + 0.5) / self.rows, self.columns)
        phi = np.tile(np.pi * (np.arange(self.columns) + 0.5) / self.columns, self.rows)
        radius = np.sqrt(1.0 - z * z)
        return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)

    @property
    def area(self) -> float:
        """Steradians of a bin, with its mirror image in y < 0."""
        return 2.0 * np.pi / (self.rows * self.columns)

    def masses(self, o: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Sums ``(n,)`` of ``weight`` ``(k,)`` over directions ``o`` ``(k, 3)``."""
        row = np.minimum((o[:, 2] * self.rows).astype(int), self.rows - 1)
        phi = np.arctan2(np.abs(o[:, 1]), o[:, 0]) / np.pi
        column = np.minimum((phi * self.columns).astype(int), self.columns - 1)
        return np.bincount(row * self.columns + column, weight, self.rows * self.columns)


BINS = Bins()
DIRECTIONS = BINS.o


def orders(surface: Surface, wi: np.ndarray) -> tuple[np.ndarray, float]:
    """White glass: densities ``(2, 2, n)`` at BINS, and the mean order of further bounces. The
    first axis is bounce 1 and further ones, the second light that comes back and goes through, each
    in the frame of its side."""
    masses, order = np.zeros((2, 2, DIRECTIONS.shape[0])), 0.0
    start = np.broadcast_to(wi, (WALKS, 3))
    for k, step in enumerate(bounces(start, surface, BOUNCES, np.random.default_rng(SEED))):
        for side in (0, 1):
            out = (step.below_after == bool(side)) & (step.o[:, 2] > 0.0)
            masses[min(k, 1), side] += BINS.masses(step.o[out], step.leaving[out, 0])
        if k > 0:
            order += (k + 1) * step.leaving.sum()
    energy = masses[1].sum()
    return masses / (WALKS * BINS.area), order / energy if energy > 0.0 else 2.0


def plateau() -> np.ndarray:
    """Knots of the ramp about the normal whose energy is 1."""
    area = sum(PLATEAU) - 0.5 * (PLATEAU[0] + PLATEAU[-1])
    return np.array(PLATEAU) * (KNOTS - 1) / (2.0 * area)


def tilted(angle: float) -> np.ndarray:
    """The direction ``(3,)`` in the plane of incidence, leaning towards the viewer."""
    return np.array([np.sin(angle), 0.0, np.cos(angle)])


def steep_lobe(wi: np.ndarray, angle: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Cycles' Beckmann refraction of STEEP_INDEX about a normal leaning by ``angle``: its values
    ``(n,)`` at BINS on the other side, in that side's frame, and where samples of it go."""
    o, normal = DIRECTIONS, tilted(angle)
    h = STEEP_INDEX * o - wi
    length = np.linalg.norm(h, axis=1)
    h = h / length[:, None]
    arriving, leaving = h @ wi, (h * o).sum(axis=1)
    z = np.clip(h @ normal, 1e-6, 1.0)
    exponent = np.minimum((1.0 - z * z) / (z * z * width**2), 700.0)
    density = np.exp(-exponent) / (np.pi * width**2 * z**4)
    cosines = np.maximum(np.stack([o @ normal, np.full(len(o), wi @ normal)]), 1e-6)
    masking = 1.0 + cycles_lambda(cosines, width, True).sum(axis=0)
    values = density * np.abs(arriving * leaving) * (STEEP_INDEX / length) ** 2
    return values / (cosines[1] * masking) * (o @ normal > 0.0), arriving > 0.0


def lobe_energy(
    wi: np.ndarray, shape: np.ndarray, distribution: str, crossed: bool, count: int = 24
) -> float:
    """The energy that Cycles' samples of a tilted lobe of weight 1 keep, steep or microfacet.
    ``shape``: the normal's angle, the lobe's alpha."""
    normal, alpha = tilted(shape[0]), shape[1]
    axes = np.array([[normal[2], 0.0, -normal[0]], [0.0, 1.0, 0.0], normal])
    surface, v = Surface(alpha, alpha, distribution), axes @ wi
    m, weight = visible_normals(v, surface, count)
    c = np.maximum(m @ v, 0.0)
    density = c * D(m, surface) * weight
    o = m if crossed else 2.0 * c[:, None] * m - v
    beckmann = distribution == BECKMANN
    here = 1.0 + cycles_lambda(v[2], alpha, beckmann)
    kept = here / (here + cycles_lambda(o[:, 2], alpha, beckmann))
    kept *= (o[:, 2] > 0.0) & (o @ axes[:, 2] > 0.0)
    return float((density * kept).sum() / density.sum())


def legal(wi: np.ndarray, shape: np.ndarray, lobe: int) -> np.ndarray:
    """``shape`` (angle, width) with a normal that Cycles leaves alone, and a width within limits;
    ``lobe`` 0 comes back, 1 goes through."""
    theta = np.arccos(wi[2])
    reach = 0.5 * np.pi - 0.02
    width = np.clip(shape[1], *(limits[1 - lobe] for limits in (NARROWEST, WIDEST)))
    return np.array([np.clip(shape[0], 0.5 * (theta - reach), 0.5 * (theta + reach)), width])


def part(
    surface: Surface, wi: np.ndarray, density: np.ndarray, lobe: int
) -> tuple[list[float], float]:
    """A side's share of its tilted lobe, that lobe's root of the weight for an energy of 1, angle
    and width; and the squared error over the side. ``density`` ``(n,)``; ``lobe`` as in `legal`."""
    alpha, eta = surface.alpha_x, surface.material.ior
    energy = density.sum() * BINS.area
    broad = DIRECTIONS[:, 2] / np.pi if lobe else knots(DIRECTIONS[:, 2]) @ plateau() / np.pi
    beckmann = surface.distribution == BECKMANN
    if lobe:
        flat = np.arcsin(min(np.sqrt(1.0 - wi[2] ** 2) / eta, 1.0))
        start = np.array([flat + 0.2 * alpha, STEEP_START * alpha + 0.1])
    else:
        start = np.array([0.0, min(alpha, WIDEST[1])])

    def values(shape: np.ndarray) -> tuple[np.ndarray, float]:
        if lobe:
            found, reached = steep_lobe(wi, *shape)
        else:
            found = microfacet(DIRECTIONS, wi, tilted(shape[0]), (shape[1], shape[1]), beckmann)
            reached = np.ones(len(found))
        return found, float((found * reached).sum() * BINS.area)

    def fit(shape: np.ndarray) -> tuple[float, float, float]:
        found, sampled = values(shape)
        # The lobe has `share` of the energy, so its values are scaled by share / sampled.
        away = energy * (found / max(sampled, 1e-6) - broad)
        wanted = density - energy * broad
        share = float(np.clip((away @ wanted) / max(away @ away, 1e-30), 0.0, 1.0))
        return float(((share * away - wanted) ** 2).sum() * BINS.area), share, sampled

    scale = float((density**2).sum() * BINS.area)
    if scale <= 0.0:
        return [0.0, 1.0, *legal(wi, start, lobe)], 0.0

    def cost(shape: np.ndarray) -> float:
        there = legal(wi, shape, lobe)
        step = (there - start) / (0.2, start[1])
        out = (shape - there) / (0.2, start[1])
        return fit(there)[0] / scale + INERTIA * float(step @ step) + float(out @ out)

    simplex = start + np.array([[0.0, 0.0], [0.2, 0.0], [0.0, 0.5 * start[1]]])
    options = {"maxfev": 60, "initial_simplex": simplex, "xatol": 2e-3, "fatol": 1e-6}
    shape = legal(wi, minimize(cost, start, method="Nelder-Mead", options=options).x, lobe)
    error, share, _ = fit(shape)
    distribution = BECKMANN if lobe else surface.distribution
    root = lobe_energy(wi, shape, distribution, bool(lobe)) ** -0.5
    return [share, root, *shape], error


def node(surface: Surface, cosine: float) -> tuple[np.ndarray, float]:
    """The values of one node ``(VALUES,)``, and the fit's error, the walks' noise included: as
    image L2 over both sides, relative to all bounces."""
    wi = view(cosine)
    density, order = orders(surface, wi)
    energy = density[1].sum(axis=1)
    back, back_error = part(surface, wi, density[1, 0], 0)
    through, through_error = part(surface, wi, density[1, 1], 1)
    thinner = energy[0] if surface.material.ior > 1.0 else energy[1]
    share = np.sqrt(thinner / energy.sum()) if energy.sum() > 0.0 else 0.0
    scale = float((density.sum(axis=0) ** 2).sum() * BINS.area)
    kept = (order - 2.0) / (order - 1.0)
    values = np.array([share, *through, *back, kept])
    return values, float(np.sqrt((back_error + through_error) / scale))


def row(distribution: str, inside: bool, index: int, alpha: int) -> tuple[np.ndarray, np.ndarray]:
    """The nodes of one index and alpha, ``(COSINES, VALUES)``, and their errors."""
    count, alphas, cosines = SHAPES
    eta, width = indices(count, inside)[index], grid.alphas(alphas)[alpha]
    surface = Surface(width, width, distribution, Dielectric(eta))
    found = [node(surface, cosine) for cosine in grid.cosines(width, cosines)]
    return np.array([one[0] for one in found]), np.array([one[1] for one in found])


def shapes(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Shapes ``(4, *SHAPES, VALUES)`` of GGX and Beckmann from outside, then from inside, and their
    errors. A mirror has the shapes of the next alpha."""
    count, alphas, cosines = SHAPES
    wanted = [
        (distribution, inside, index, alpha)
        for inside in (False, True)
        for distribution in (GGX, BECKMANN)
        for index in range(count)
        for alpha in range(1, alphas)
    ]
    found = run(row, wanted, "glass, shapes")
    values = np.array([one[0] for one in found]).reshape(4, count, alphas - 1, cosines, VALUES)
    errors = np.array([one[1] for one in found]).reshape(4, count, alphas - 1, cosines)
    return np.concatenate([values[:, :, :1], values], axis=2), errors


def function(name: str, comment: str, table: np.ndarray, sides: int = 1) -> str:
    """A function that interpolates in ``table`` ``(sides * 2, indices, alphas, cosines, values)``,
    GGX first. Raises ValueError if a value is not finite."""
    if not np.isfinite(table).all():
        raise ValueError(f"{name}: {np.count_nonzero(~np.isfinite(table))} values are not finite")
    _, count, alphas, cosines, values = table.shape
    which = "(2 * inside + distribution)" if sides > 1 else "distribution"
    return FUNCTION.format(
        name=name,
        indent=" " * len(f"void {name}("),
        comment=comment,
        side="int inside, " if sides > 1 else "",
        count=values,
        size=table.size,
        rows="\n".join(header.wrapped(table.ravel())),
        alphas=alphas,
        cosines=cosines,
        indices=count,
        first=f"{which} * {count * alphas * cosines}",
    )


def body(run: Run) -> tuple[list[str], str]:
    """The header's own description, and its functions."""
    values, errors = shapes(run)
    columns = header.columns("White glass:", "GLASS", LAYOUT)
    missing = header.columns("Energies of white glass:", "GLASS", MISSING_LAYOUT)
    parts = [
        '#include "../include/table3.h"\n',
        header.array("plateau_knot", "Knots of a ramp of energy 1.", plateau()),
        header.constant("LOWEST_INDEX", LOWEST_INDEX)
        + header.constant("HIGHEST_INDEX", HIGHEST_INDEX),
        function("dielectric_shape", columns, values, sides=2),
        function("dielectric_energy_outside", missing, energies(run, False)),
        function("dielectric_energy_inside", "// The same from inside.", energies(run, True)),
    ]
    return header.provenance(SEED, WALKS, errors), "\n".join(parts)
