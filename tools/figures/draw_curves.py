# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Fig. 2, masking on the full sphere, and Fig. 17, reciprocity."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from osl.oracle.surface import BECKMANN, GGX

from .cache import Result
from .cases import MASKING, RECIPROCITY, RECIPROCITY_MODELS
from .draw import BOUNCE_COLOURS, FAINT, INK, WIDTH, heading, place, svg
from .masking_curves import MaskingCurve
from .reciprocity import Pairs

_LEFT, _GAP = 0.75, 0.75  # inches
_MARKS = 30  # of the integral on a curve
_NDF_NAMES = {GGX: "GGX", BECKMANN: "Beckmann"}


def draw_masking(curves: dict[MaskingCurve, Result]) -> str:
    """Fig. 2 as SVG."""
    page = Figure(figsize=(WIDTH, 4.6))
    title = "Distant masking G₁ on the full sphere"
    heading(
        page,
        f"Fig. {MASKING}: {title}",
        "Lines: eq. (3). Circles: numeric integral, eq. (4). It may exceed 1 below the horizon, "
        "θ > π/2. Lower row: relative difference.",
    )
    wide = (WIDTH - _LEFT - _GAP - 0.15) / 2
    for column, distribution in enumerate(_NDF_NAMES):
        left = _LEFT + column * (wide + _GAP)
        top, bottom = place(page, left, 0.85, wide, 2.2), place(page, left, 3.3, wide, 0.8)
        mine = [curve for curve in curves if curve.surface.distribution == distribution]
        for curve, colour in zip(mine, BOUNCE_COLOURS, strict=False):
            theta, formula, integral = (
                curves[curve][key] for key in ("theta", "formula", "integral")
            )
            finite = np.isfinite(formula)
            some = np.flatnonzero(finite)[:: max(1, theta.size // _MARKS)]
            top.plot(theta[finite], formula[finite], color=colour, zorder=2)
            top.plot(theta[some], integral[some], "o", color=colour, ms=3.6, mfc="none", mew=0.8)
            top.plot([], [], "-o", color=colour, ms=3.6, mfc="none", mew=0.8,
                     label=f"α = {curve.surface.alpha_x:g}")  # fmt: skip
            deviation = np.abs(integral[finite] / formula[finite] - 1.0)
            bottom.plot(theta[finite], np.maximum(deviation, 1e-17), color=colour, lw=0.9)
        top.set(yscale="log", ylim=(1e-2, 1e4 if distribution == GGX else 1e8))
        top.set_title(_NDF_NAMES[distribution], color=INK)
        top.legend(loc="upper left", handlelength=2.2)
        top.axhline(1.0, color=FAINT, lw=0.6, ls=":")
        bottom.set(yscale="log", ylim=(1e-17, 1e-10), yticks=[1e-16, 1e-13, 1e-10], xlabel="θ")
        ticks = np.pi * np.arange(5) / 4
        for axes in (top, bottom):
            axes.set(xlim=(0.0, np.pi))
            axes.set_xticks(ticks, ["0", "π/4", "π/2", "3π/4", "π"])
            axes.axvline(0.5 * np.pi, color=FAINT, lw=0.6, ls=":")
            axes.minorticks_off()
        if column == 0:
            top.set_ylabel("G₁")
            bottom.set_ylabel("|(4) / (3) − 1|")
    return svg(page, f"Fig. {MASKING}: {title}")


def draw_reciprocity(models: dict[str, Pairs]) -> str:
    """Fig. 17 as SVG."""
    page = Figure(figsize=(WIDTH, 5.5))
    title = "Reciprocity of the models"
    heading(
        page,
        f"Fig. {RECIPROCITY}: {title}",
        "White rough conductor, GGX, α = 1. Random pairs of directions, of which ωi is always the "
        "more grazing one; the outermost 0.5 % are not shown.",
    )
    wide = (WIDTH - _LEFT - _GAP - 0.15) / 2
    for column, model in enumerate(RECIPROCITY_MODELS):
        pairs, left = models[model], _LEFT + column * (wide + _GAP)
        upper, lower = (place(page, left, top, wide, 1.65) for top in (0.95, 3.3))
        mean, error = pairs.mean_difference
        upper.set_title(model.capitalize(), color=INK)
        upper.set_xlabel("ρ(ωi, ωo) − ρ(ωo, ωi), per steradian")
        _histogram(upper, pairs.difference, column)
        _note(upper, f"mean {mean:.5f}\n± {error:.5f}")
        lower.set_xlabel("the same in standard errors; line: unit normal")
        width = _histogram(lower, pairs.z, column)
        x = np.linspace(*lower.get_xlim(), 200)
        normal = np.exp(-0.5 * x * x) / np.sqrt(2.0 * np.pi)
        lower.plot(x, normal * pairs.z.size * width, color=INK, lw=1.0)
        _note(lower, f"mean {pairs.z.mean():.2f}\nstandard deviation {pairs.z.std(ddof=1):.2f}")
    return svg(page, f"Fig. {RECIPROCITY}: {title}")


def _histogram(axes: Axes, values: np.ndarray, column: int) -> float:
    """Draw the histogram of ``values`` about zero, with a line at their mean; the bins' width."""
    reach = np.quantile(np.abs(values), 0.995)
    edges, width = np.linspace(-reach, reach, 40, retstep=True)
    colour = BOUNCE_COLOURS[column]
    axes.hist(values, edges, color=colour, alpha=0.35)
    axes.axvline(0.0, color=FAINT, lw=0.6, ls=":")
    axes.axvline(values.mean(), color=colour, lw=1.2)
    axes.set(xlim=(-reach, reach), ylabel="pairs")
    return width


def _note(axes: Axes, text: str) -> None:
    low, high = axes.get_ylim()
    axes.set_ylim(low, 1.25 * high)
    axes.text(
        0.98,
        0.96,
        text.replace("-", "−"),
        transform=axes.transAxes,
        ha="right",
        va="top",
        color=INK,
    )
