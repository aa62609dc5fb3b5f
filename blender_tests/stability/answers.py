# SPDX-License-Identifier: GPL-3.0-or-later
"""What the oracle says of the functions under test, for rows that each have a surface of their own.

Directions are float64 (n, 3), `alpha` (n, 3) is alpha_x, alpha_y and the number of distribution and
model that samples.SURFACE takes, everything else is (n,); results are (n,) or (n, channels).
"""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
from scipy.special import gammaln

from osl.oracle import masking, visible
from osl.oracle.fresnel import dielectric_reflectance
from osl.oracle.materials import Dielectric
from osl.oracle.ndf import sigma
from osl.oracle.surface import BECKMANN, CORRELATED, GGX, HEIGHT_TRACKED, MODELS
from osl.oracle.vectors import dot

# The smallest random number but 0.
SMALLEST = 1e-7
# Single precision ends at 1e-38, and the shader's cut of Beckmann's tail lies at 1e-36.
SMALLEST_AREA = 1e-30


class Given:
    """Stands for a random generator: returns numbers (n,) that are given, in turn."""

    def __init__(self, *numbers: np.ndarray) -> None:
        self._numbers = iter(numbers)

    def random(self, _: int) -> np.ndarray:
        return next(self._numbers)


def of_surfaces(
    function: Callable[..., np.ndarray], alpha: np.ndarray, *columns: np.ndarray
) -> np.ndarray:
    """`function(*columns, surface)`, where each row has a surface of its own, `alpha` (n, 3)."""
    parts, order = [], []
    for kind in np.unique(alpha[:, 2]):
        rows = np.flatnonzero(alpha[:, 2] == kind)
        surface = SimpleNamespace(
            alpha_x=alpha[rows, 0],
            alpha_y=alpha[rows, 1],
            distribution=BECKMANN if kind % 2 else GGX,
            model=MODELS[int(kind) // 2],
        )
        parts.append(function(*(column[rows] for column in columns), surface))
        order.append(rows)
    return np.concatenate(parts)[np.argsort(np.concatenate(order))]


def areas(alpha: np.ndarray, view: np.ndarray) -> np.ndarray:
    """sigma(v), and sigma of v mirrored to below the horizon, (n, 2)."""
    below = view * np.where(view[:, 2:] > 0.0, -1.0, 1.0)
    return np.stack([of_surfaces(sigma, alpha, w) for w in (view, below)], axis=-1)


def leaving(alpha: np.ndarray, view: np.ndarray, o: np.ndarray) -> np.ndarray:
    """Chance that a reflected path from `view` leaves towards `o`, by the row's model."""

    def odds(v: np.ndarray, o: np.ndarray, s: SimpleNamespace) -> np.ndarray:
        area, back = sigma(v, s), sigma(-o, s)
        return masking.exit_odds(v, area, o, back, None, None, s.model).p_exit

    return of_surfaces(odds, alpha, view, o)


def escaping(alpha: np.ndarray, o: np.ndarray, log_u: np.ndarray) -> np.ndarray:
    """Chance that a path at height `log_u` leaves towards `o`."""

    def odds(o: np.ndarray, log_u: np.ndarray, s: SimpleNamespace) -> np.ndarray:
        return masking.exit_odds(o, None, o, sigma(-o, s), None, log_u, HEIGHT_TRACKED).p_exit

    return of_surfaces(odds, alpha, o, log_u)


def met(alpha: np.ndarray, view: np.ndarray, number: np.ndarray) -> np.ndarray:
    """log(u) where a path from `view` meets the surface, for a random `number`."""

    def height(v: np.ndarray, number: np.ndarray, s: SimpleNamespace) -> np.ndarray:
        down = -np.abs(v)  # from the top downwards, whichever side of the horizon v is on
        return masking.next_height(np.zeros(len(v)), down, sigma(v, s), Given(1.0 - number))

    return of_surfaces(height, alpha, view, number)


def next_heights(
    alpha: np.ndarray, o: np.ndarray, log_u: np.ndarray, number: np.ndarray
) -> np.ndarray:
    """log(u) where a path at height `log_u` towards `o` meets the surface, if it stays."""

    def height(o: np.ndarray, log_u: np.ndarray, x: np.ndarray, s: SimpleNamespace) -> np.ndarray:
        draw = np.where(o[:, 2] > 0.0, x, 1.0 - x)
        return masking.next_height(log_u, o, sigma(-o, s), Given(draw))

    return of_surfaces(height, alpha, o, log_u, number)


def crossing(alpha: np.ndarray, view: np.ndarray, o: np.ndarray) -> np.ndarray:
    """Chance that a path from `view` leaves towards `o` after it has crossed, height-correlated."""

    def odds(v: np.ndarray, o: np.ndarray, s: SimpleNamespace) -> np.ndarray:
        crossed = np.ones(len(v), dtype=bool)
        return masking.exit_odds(v, sigma(v, s), o, sigma(-o, s), crossed, None, CORRELATED).p_exit

    return of_surfaces(odds, alpha, view, o)


def stirling(part: np.ndarray) -> np.ndarray:
    """log Gamma(x) less Stirling's formula, at x = 1 / `part`; from x = 100 on its series."""
    x = 1.0 / np.maximum(part, 0.01)
    exact = gammaln(x) - (x - 0.5) * np.log(x) + x - 0.5 * np.log(2.0 * np.pi)
    return np.where(part > 0.01, exact, part / 12.0 - part**3 / 360.0)


def _glass(eta: np.ndarray) -> SimpleNamespace:
    """A dielectric whose index differs from row to row."""
    return SimpleNamespace(eta=lambda below: eta)


def through(view: np.ndarray, m: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Where a facet `m` refracts to, (n, 3)."""
    return Dielectric.scatter(_glass(eta), view, m, None, Given(np.full(len(m), np.inf))).o


def scattered(view: np.ndarray, m: np.ndarray, eta: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Where a facet `m` of glass sends a path, by the first random number, (n, 3)."""
    return Dielectric.scatter(_glass(eta), view, m, None, Given(xi[:, 0])).o


def seen(alpha: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Whether single precision tells the area seen from `view` from none: paths that see no facet
    carry no weight, and what they do next has no answer."""
    return of_surfaces(sigma, alpha, view) > SMALLEST_AREA


def stays(alpha: np.ndarray, o: np.ndarray, log_u: np.ndarray) -> np.ndarray:
    """Whether paths to `o` stay more often than the smallest random number."""
    return seen(alpha, -o) & (1.0 - escaping(alpha, o, log_u) > SMALLEST)


def around(m: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Where Diffuse takes the direction from, before it is normalised: 0 at one point of the
    sphere, about which no direction is known."""
    z = 1.0 - 2.0 * xi[:, 0]
    radius, phi = np.sqrt(1.0 - z * z), 2.0 * np.pi * xi[:, 1]
    return m + np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)


def clearly_chosen(view: np.ndarray, m: np.ndarray, eta: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Whether the facet faces the path and rounding does not decide if it reflects."""
    cosine = dot(view, m)
    near = [dielectric_reflectance(cosine + d, eta) for d in (-1e-6, 0.0, 1e-6)]
    return np.all(np.abs(np.array(near) - xi[:, 0]) > 1e-4, axis=0) & (cosine >= 0.0)


def metals(kind: type, f0: np.ndarray, f1: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Reflectances (n, 3) of metals of `kind`, whose parameters are `f0` and `f1` (n, 3)."""
    rows = zip(f0, f1, cosine, strict=True)
    return np.array([kind(tuple(first), tuple(second))(c) for first, second, c in rows])


def normals(alpha: np.ndarray, view: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """GGX's micronormals (n, 3) for the random numbers `xi` (n, 3)."""
    return of_surfaces(lambda v, u, s: visible.from_uniforms(v, u[:, :2], s), alpha, view, xi)
