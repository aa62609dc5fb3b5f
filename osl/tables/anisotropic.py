# SPDX-License-Identifier: GPL-3.0-or-later
"""The further bounces of an anisotropic rough metal as three closures, for anisotropic_lobes.h.

The closures are a ramp about the normal, and two microfacet lobes whose normals tilt in the plane
of the stretched view. Surfaces have two alphas and views two angles, too many for a table of nodes.
So polynomials in these four describe the closures, fitted to all views at once.
"""

import numpy as np
from scipy.linalg import solve

from osl.oracle import BECKMANN, GGX

from . import header, polynomial
from .anisotropic_views import (
    RESOLVED,
    WALKS,
    Sample,
    View,
    exits,
    first,
    missing_energy,
    sampled,
    views,
)
from .closures import KNOTS, knots, microfacet, normalized
from .fitting import SEED
from .polynomial import Polynomial, least
from .run import Run

# Files that decide on the values, besides this one and the shared ones.
SOURCES = ("anisotropic_views.py", "conductor.py", "polynomial.py")

DISTRIBUTIONS = (GGX, BECKMANN)
VIEWS = 512  # for the fit of the shapes
ENERGY_VIEWS = 2048  # for the fit of the energies
STEPS = (10, 5)  # of the fit: first all views count alike, then the worst count more
FAINTEST = 1e-3  # views of less energy take no part in the fit of shapes

POLYNOMIALS = (
    Polynomial("ENERGY", "energy over stretched_cosine (Beckmann), its root (GGX)", 7, 4, 0.0, 2.0),
    Polynomial("LOBE_1", "microfacet lobe 1", 4, 4, 0.0, 9.0),
    Polynomial("LOBE_2", "microfacet lobe 2", 4, 4, 0.0, 9.0),
    Polynomial("RAMP_HALFWAY", "ramp that is highest halfway up", 3, 4, 0.0, 9.0),
    Polynomial("RAMP_POLE", "ramp that is highest at the pole", 3, 4, 0.0, 9.0),
    Polynomial("TILT_1", "tilt of lobe 1", 3, 3, -3.0, 4.0),
    Polynomial("WIDTH_X_1", "its alpha_x over the surface's", 3, 3, 0.15, 4.0),
    Polynomial("WIDTH_Y_1", "its alpha_y over the surface's", 3, 3, 0.15, 4.0),
    Polynomial("TILT_2", "tilt of lobe 2", 3, 3, -3.0, 4.0),
    Polynomial("WIDTH_X_2", "its alpha_x over the surface's", 3, 3, 0.15, 4.0),
    Polynomial("WIDTH_Y_2", "its alpha_y over the surface's", 3, 3, 0.15, 4.0),
    Polynomial("SHARE_2", "share of bounce 2", 3, 4, 0.0, 1.0),
    Polynomial("FRESNEL_2", "cosine at which Fresnel is its mean in bounce 2", 3, 4, 0.0, 1.0),
    Polynomial("FRESNEL_LATER", "the same in later bounces", 3, 4, 0.0, 1.0),
    Polynomial("REST", "energy of bounces above 3 over that of all above 2", 2, 4, 0.0, 0.99),
)
ENERGY, SHAPE, COLOUR = POLYNOMIALS[0], POLYNOMIALS[1:11], POLYNOMIALS[11:]
# The first LINEAR parameters of a shape are factors of closures. Each microfacet lobe has LOBE
# more.
LINEAR, LOBE = 4, 3
STEP = (0.02, 0.01, 0.01)  # of the finite differences by a lobe's parameters
LOW, HIGH = np.array([one.low for one in SHAPE]), np.array([one.high for one in SHAPE])
START = {
    GGX: (0.57, 0.19, 0.35, 0.24, 0.27, 1.0, 1.1, -0.44, 1.7, 1.9),
    BECKMANN: (0.6, 0.25, 0.1, 0.04, 0.6, 0.64, 0.67, -0.45, 0.9, 0.73),
}
ENERGY_WEIGHT = 8.0  # weight of an error in energy against the relative error of the shape
STIFFNESS = 1e-7  # what a coefficient of degree 0 costs, squared
NONLINEAR_STIFFNESS = 10.0  # times as much for a coefficient that changes a lobe


def bent(normal: np.ndarray, wi: np.ndarray) -> np.ndarray:
    """The normal that Cycles uses: it bends one until the mirrored view is above the surface."""
    lift = min(0.9 * wi[2], 0.01)
    if 2.0 * (normal @ wi) * normal[2] - wi[2] >= lift:
        return normal
    along = normalized(normal * [1.0, 1.0, 0.0])
    x, z = along @ wi, wi[2]
    elevation = 0.5 * (np.arccos(lift / np.hypot(x, z)) + np.arctan2(x, z))
    return np.sin(elevation) * along + np.array([0.0, 0.0, np.cos(elevation)])


def microfacet_lobe(view: View, o: np.ndarray, index: int, shape: np.ndarray) -> np.ndarray:
    """One of the microfacet lobes at weight 1, ``(n,)``, by the parameters of a shape ``(10,)``.
    The second of GGX is Beckmann, which has no tails."""
    tilt, *wider = shape[LINEAR + index * LOBE : LINEAR + (index + 1) * LOBE]
    surface, wi = view.surface, view.wi
    alphas = np.array([surface.alpha_x, surface.alpha_y])
    slope = tilt * alphas * view.stretched / (wi[2] + np.hypot(*view.stretched))
    z = bent(normalized(np.array([*slope, 1.0])), wi)
    y = normalized(np.cross(z, [1.0, 0.0, 0.0]))
    axes = np.stack([np.cross(y, z), y, z])
    widths = tuple(np.minimum(wider * alphas, 1.0))
    beckmann = surface.distribution == BECKMANN or index == 1
    return microfacet(o @ axes.T, axes @ wi, np.array([0.0, 0.0, 1.0]), widths, beckmann)


def ramps(o: np.ndarray) -> np.ndarray:
    """The ramp's two parts ``(n, 2)``: largest at half height, and at the pole."""
    at = np.arange(KNOTS) / (KNOTS - 1.0)
    return knots(o[:, 2]) @ np.stack([2.0 * at * (1.0 - at), at * at], axis=-1) / np.pi


def columns(view: View, o: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """All closures at weight 1, ``(n, LINEAR)``, by the parameters of their shape ``(10,)``."""
    lobes = [microfacet_lobe(view, o, i, shape) for i in (0, 1)]
    return np.column_stack([*lobes, ramps(o)])


class Fit:
    """Fits the coefficients of the shapes' polynomials to all views of one distribution together,
    by least squares."""

    def __init__(self, samples: list[Sample]) -> None:
        self.samples = samples
        self.rules = [exits(s.view) for s in samples]
        place = np.array([s.view.place for s in samples])
        self.bases = [one.terms(place) for one in SHAPE]
        ends = np.cumsum([b.shape[1] for b in self.bases])
        self.parts = [slice(e - b.shape[1], e) for e, b in zip(ends, self.bases, strict=True)]
        self.stiffness = STIFFNESS * np.concatenate(
            [(1.0 + np.sum(one.exponents, axis=1)) ** 2 for one in SHAPE]
        )
        self.stiffness[self.parts[LINEAR].start :] *= NONLINEAR_STIFFNESS
        self.weight = np.ones(len(samples))
        self.found = np.zeros(ends[-1])
        start = START[samples[0].view.surface.distribution]
        self.found[[part.start for part in self.parts]] = start

    def shapes(self, found: np.ndarray) -> np.ndarray:
        """The parameters of each view ``(views, 10)``, before they are limited."""
        return np.stack(
            [b @ found[p] for b, p in zip(self.bases, self.parts, strict=True)], axis=-1
        )

    def residual(
        self, index: int, shape: np.ndarray, slopes: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """The misfit of one view ``(n + 1,)``, in units of its norm and, last, of energy, with its
        derivatives by the parameters ``(n + 1, 10)``."""
        s, rule = self.samples[index], self.rules[index]
        legal = np.clip(shape, LOW, HIGH)
        factor = s.energy * legal[:LINEAR]
        closures = columns(s.view, rule.o, legal)
        jacobian = np.zeros((len(rule.o) + 1, len(shape)))
        scale = np.sqrt(rule.weight) / s.norm

        def scaled(values: np.ndarray) -> np.ndarray:
            return np.append(values * scale, ENERGY_WEIGHT * rule.energy(values))

        if slopes:
            for i in range(LINEAR):
                jacobian[:, i] = scaled(s.energy * closures[:, i])
            for i in range(LINEAR, len(shape)):
                lobe, which = divmod(i - LINEAR, LOBE)
                moved = legal.copy()
                moved[i] += STEP[which]
                change = microfacet_lobe(s.view, rule.o, lobe, moved) - closures[:, lobe]
                jacobian[:, i] = scaled(factor[lobe] * change / STEP[which])
        missed = scaled(s.value - closures @ factor)
        missed[-1] = ENERGY_WEIGHT * (s.energy - rule.energy(closures @ factor))
        # A parameter at its limit does not move further out.
        pull = jacobian.T @ missed
        jacobian[:, (shape < LOW) & (pull < 0.0) | (shape > HIGH) & (pull > 0.0)] = 0.0
        return missed, jacobian

    def errors(self, found: np.ndarray) -> np.ndarray:
        """The relative image L2 and the error in energy of each view, ``(views, 2)``."""
        missed = [self.residual(i, one, False)[0] for i, one in enumerate(self.shapes(found))]
        return np.array([[np.sqrt((m[:-1] ** 2).sum()), m[-1] / ENERGY_WEIGHT] for m in missed])

    def cost(self, found: np.ndarray) -> float:
        """The value that the fit minimises."""
        squares = self.errors(found) ** 2 @ [1.0, ENERGY_WEIGHT**2]
        return float((self.weight * squares).sum() / self.weight.sum() + self.stiffness @ found**2)

    def improve(self, steps: int) -> None:
        """Improve the coefficients by the Levenberg-Marquardt method."""
        damping, cost = 1e-3, self.cost(self.found)
        weight = self.weight / self.weight.sum()
        for _ in range(steps):
            grams, pulls = [], []
            for i, shape in enumerate(self.shapes(self.found)):
                missed, jacobian = self.residual(i, shape, True)
                grams.append(weight[i] * jacobian.T @ jacobian)
                pulls.append(weight[i] * jacobian.T @ missed)
            gram, pull = np.array(grams), np.array(pulls)
            matrix = np.block(
                [
                    [a.T @ (gram[:, i, j, None] * b) for j, b in enumerate(self.bases)]
                    for i, a in enumerate(self.bases)
                ]
            ) + np.diag(self.stiffness)
            downhill = np.concatenate([b.T @ pull[:, i] for i, b in enumerate(self.bases)])
            downhill -= self.stiffness * self.found
            while damping < 1e3:
                damped = matrix + np.diag(damping * np.diag(matrix) + 1e-10)
                step = np.clip(solve(damped, downhill, assume_a="pos"), -0.4, 0.4)
                better = self.cost(self.found + step)
                if better < cost:
                    break
                damping *= 8.0
            else:
                return
            gain, cost = cost - better, better
            self.found = self.found + step
            damping = max(damping / 6.0, 1e-5)
            if gain < 2e-3 * cost:
                return


def colours(samples: list[Sample]) -> list[np.ndarray]:
    """The coefficients of the colours' polynomials, by least squares weighted with energy."""
    place = np.array([s.view.place for s in samples])
    energy = np.array([s.energy for s in samples])
    wanted = np.array([s.colour for s in samples]).T
    parts = zip(COLOUR, wanted, strict=True)
    return [least(energy[:, None] * one.terms(place), energy * values) for one, values in parts]


def near_horizon(view: View) -> float:
    """The factor of the energy's polynomial: it vanishes at the horizon, as energies do."""
    return view.upright if view.surface.distribution == BECKMANN else np.sqrt(view.upright)


def energy(distribution: str, shapes: list[np.ndarray]) -> np.ndarray:
    """The coefficients of the energy's polynomial that give closures of these ``shapes`` all the
    missing energy."""
    rows, wanted = [], []
    chosen = views(distribution, ENERGY_VIEWS, SEED + 1)
    place = np.array([view.place for view in chosen])
    parameters = [one.limited(place, c) for one, c in zip(SHAPE, shapes, strict=True)]
    terms = ENERGY.terms(place)
    for view, row, shape in zip(chosen, terms, np.stack(parameters, axis=-1), strict=True):
        rule, missing = exits(view), missing_energy(view)
        if abs(rule.energy(first(view, rule.o)) + missing - 1.0) < RESOLVED:
            fitted = rule.energy(columns(view, rule.o, shape) @ shape[:LINEAR])
            rows.append(near_horizon(view) * fitted * row)
            wanted.append(missing)
    return least(np.array(rows), np.array(wanted))


def fitted(distribution: str, samples: list[Sample]) -> tuple[list[np.ndarray], np.ndarray]:
    """The coefficients of all polynomials for one distribution, and the shapes' errors."""
    fit = Fit(samples)
    for steps in STEPS:
        fit.improve(steps)
        errors = fit.errors(fit.found)[:, 0]
        fit.weight = 0.3 + (errors**2 / np.mean(errors**2)) ** 1.5
    shapes = [fit.found[part] for part in fit.parts]
    return [energy(distribution, shapes), *shapes, *colours(samples)], errors


def body(run: Run) -> tuple[list[str], str]:
    """The header's own description, and its function."""
    chosen = [(view, i) for d in DISTRIBUTIONS for i, view in enumerate(views(d, VIEWS, SEED))]
    samples = run(sampled, chosen, "anisotropic metal, walks")
    samples = [s for s in samples if s.resolved and s.energy > FAINTEST]
    parts = [(d, [s for s in samples if s.view.surface.distribution == d]) for d in DISTRIBUTIONS]
    found = run(fitted, parts, "anisotropic metal, fits")
    layout = [(one.name, one.meaning, 1) for one in POLYNOMIALS]
    what = "Anisotropic white metal, by variables from -1 to 1:"
    comment = header.columns(what, "ANISOTROPIC", layout)
    function = polynomial.function(
        "anisotropic_values", comment, POLYNOMIALS, [one[0] for one in found]
    )
    errors = np.concatenate([one[1] for one in found])
    about = [
        f"Seed {SEED}, {len(samples)} views, {WALKS} walks each. Error of the shapes, as image L2",
        f"over the hemisphere relative to all bounces: mean {np.mean(errors):.1%}, at most "
        f"{np.max(errors):.1%}.",
    ]
    count = header.constant("ANISOTROPIC_VALUES", len(POLYNOMIALS))
    return about, f"{count}\n{function}"
