# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the figures as CSV."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from .cache import Result
from .cases import COLUMNS, THETAS, Alpha, LobeFigure
from .findings import Comparison, Findings, Panels
from .gains import totals, z_scores
from .lobes import BOUNCE_NAMES, LOBE_NAMES, Lobes, plane_angles
from .masking_curves import MaskingCurve
from .reciprocity import Pairs

_ENERGIES = "bounce", "E_r", "E_r_error", "E_t", "E_t_error"


def masking(curves: dict[MaskingCurve, Result]) -> str:
    """Fig. 2: G1 by eq. 3 (``formula``) and by eq. 4 (``integral``); theta in radians."""
    rows = (
        (curve.surface.distribution, curve.surface.alpha_x, *(f"{value:.13g}" for value in point))
        for curve, found in curves.items()
        for point in zip(found["theta"], found["formula"], found["integral"], strict=True)
    )
    return _csv(("distribution", "alpha", "theta", "formula", "integral"), rows)


def energies(panels: Panels) -> str:
    """Figs. 5-16: energies by bounce, and of all bounces, with standard errors."""
    rows = (
        (f"{theta:g}", column, *row)
        for theta in THETAS
        for column in COLUMNS
        for row in _energies(panels[column, theta])
    )
    return _csv(("theta", "column", *_ENERGIES), rows)


def ggx_energies(surfaces: dict[Alpha, Panels]) -> str:
    """The models' energies for GGX, a white conductor."""
    rows = (
        (*alpha, f"{theta:g}", model, *row)
        for alpha, panels in surfaces.items()
        for (model, theta), lobes in panels.items()
        for row in _energies(lobes)
    )
    return _csv(("alpha_x", "alpha_y", "theta", "model", *_ENERGIES), rows)


def lobes(figure: LobeFigure, panels: Panels) -> str:
    """Figs. 5-16: energy per radian of psi, the angle from the normal in the plane of incidence,
    away from the light; a column for the middle of each bin, in degrees."""
    psi = np.degrees(plane_angles())
    shown = np.flatnonzero(figure.transmits | (np.abs(psi) < 90.0))
    rows = (
        (f"{theta:g}", column, bounce, *(_short(value) for value in density[shown]))
        for theta in THETAS
        for column in COLUMNS
        for bounce, density in zip(LOBE_NAMES, panels[column, theta].plane.mean, strict=True)
    )
    return _csv(("theta", "column", "bounce", *(f"{one:g}" for one in psi[shown])), rows)


def reciprocity(models: dict[str, Pairs]) -> str:
    """Fig. 17: pairs of directions by their angles in radians, and for each model
    rho(wi, wo) - rho(wo, wi) and its standard error."""
    first = next(iter(models.values()))
    angles = [
        angle
        for w in (first.wi, first.wo)
        for angle in (np.arccos(w[:, 2]), np.arctan2(w[:, 1], w[:, 0]))
    ]
    values = [value for pairs in models.values() for value in (pairs.difference, pairs.error)]
    rows = (
        (*_fixed(angle, 4), *(f"{one:.3e}" for one in value))
        for angle, value in zip(np.stack(angles, axis=1), np.stack(values, axis=1), strict=True)
    )
    names = [f"{model}{suffix}" for model in models for suffix in ("", "_error")]
    return _csv(("theta_i", "phi_i", "theta_o", "phi_o", *names), rows)


def distances(comparisons: Iterable[Comparison]) -> str:
    """Distances of lobes, in shares of the incident light, and what noise alone would make."""
    rows = (
        (one.distribution, one.material, *one.alpha, f"{one.theta:g}", one.model, bounce, *numbers)
        for one in comparisons
        for bounce, *numbers in zip(
            (*LOBE_NAMES, "all"), _fixed(one.distance, 5), _fixed(one.noise, 5), strict=True
        )
    )
    header = "distribution", "material", "alpha_x", "alpha_y", "theta", "model", "bounce"
    return _csv((*header, "distance", "noise"), rows)


def estimators(found: Findings) -> str:
    """The scatter of the walk and the bidirectional estimator for GGX (`gains.Gain`); empty if
    unknown."""
    rows = (
        (model, material, *alpha, bounce, pairs, *unknown, *map(_known, (*deviation, ratio)))
        for (model, material, alpha), gain in found.gains.items()
        for bounce, (pairs, unknown, deviation, ratio) in enumerate(
            zip(gain.pairs, gain.unknown.T, gain.deviation.T, gain.ratio, strict=True), 2
        )
    )
    header = "model", "material", "alpha_x", "alpha_y", "bounce", "pairs"
    each = [f"{one}_{of}" for of in ("unknown", "deviation") for one in ("walk", "bidirectional")]
    return _csv((*header, *each, "variance_ratio"), rows)


def settled(found: Findings) -> str:
    """Pairs of directions whose two values were far apart, for GGX.

    Angles are in radians. Values are BSDF times abs(cos theta_o), bounces 2 to 6, with many walks.
    ``z`` is with few walks, ``z_settled`` with many.
    """
    rows = []
    for ((model, material, alpha), pair), (task, result) in found.settled.items():
        angles = [
            f"{angle:.4f}"
            for w in task.directions()
            for angle in (np.arccos(w[0, 2]), np.arctan2(w[0, 1], w[0, 0]))
        ]
        values = [f"{one[0]:.4e}" for both in zip(*totals(result), strict=True) for one in both]
        z = z_scores(found.estimates[model, material, alpha])[pair], z_scores(result)[0]
        rows.append((model, material, *alpha, *angles, *values, *(f"{one:.2f}" for one in z)))
    header = "model", "material", "alpha_x", "alpha_y", "theta_i", "phi_i", "theta_o", "phi_o"
    each = [f"{one}{suffix}" for one in ("walk", "bidirectional") for suffix in ("", "_error")]
    return _csv((*header, *each, "z", "z_settled"), rows)


def _known(value: float) -> str:
    return f"{value:.4g}" if np.isfinite(value) else ""


def _energies(lobes: Lobes) -> Iterator[Sequence[str]]:
    """A row for each bounce, and one for all."""
    columns = [
        _fixed(np.append(by_bounce[:, side], total[side]), 6)
        for side in range(2)
        for by_bounce, total in (
            (lobes.energies.mean, lobes.total.mean),
            (lobes.energies.error, lobes.total.error),
        )
    ]
    return zip((*BOUNCE_NAMES, "all"), *columns, strict=True)


def _fixed(values: Iterable[float], digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


def _short(value: float) -> str:
    """At most four decimals, without trailing zeros."""
    return f"{value:.4f}".rstrip("0").rstrip(".") or "0"


def _csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    return "".join(",".join(str(one) for one in row) + "\n" for row in (header, *rows))
