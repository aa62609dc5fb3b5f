# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plots: error over time of each scene, the headline, and the sweeps."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from tools.figures.draw import BOUNCE_COLOURS, FAINT, INK, PAPER, WIDTH, heading, place, svg

from .curves import Curve, advantage
from .findings import SceneFindings
from .plan import (
    BOUNCES,
    CYCLES,
    CYCLES_SVM,
    EXACT,
    FITTED,
    ONE_WALK,
    PERCENTAGES,
    SINGLE,
    TRACKED,
    UNCORRELATED,
    WALK,
    WALK_COUNTS,
    WHOLE_WALK,
)
from .verdict import moment, times_text

# The colours of docs/figures. Related variants share a colour and differ in their line.
_BLUE, _ORANGE, _GREEN, _PURPLE, _ = BOUNCE_COLOURS
COLOURS = {
    SINGLE: FAINT,
    FITTED: _ORANGE,
    WALK: _BLUE,
    UNCORRELATED: _BLUE,
    TRACKED: _BLUE,
    ONE_WALK: INK,
    WHOLE_WALK: INK,
    EXACT: _PURPLE,
    CYCLES: _GREEN,
    CYCLES_SVM: _GREEN,
}
LINES = {UNCORRELATED: ":", TRACKED: "--", CYCLES_SVM: "--", ONE_WALK: "-.", WHOLE_WALK: ":"}
_LEFT, _GAP, _TOP = 0.75, 0.55, 0.75  # inches
_MARKS = "Numbers: how many times smaller the squared error is."
_HALO = [withStroke(linewidth=2.0, foreground=PAPER)]


def draw_scene(found: SceneFindings) -> str:
    """Error over time of all variants, compared at one time."""
    figure = Figure(figsize=(WIDTH, 4.6))
    heading(figure, found.scene.title, f"{note(found)} {_MARKS}")
    axes = place(figure, _LEFT, _TOP, 5.9, 3.2)
    shown = [curve for curve in found.curves.values() if curve.known]
    _curves(axes, shown, found.resolution)
    _marks(axes, shown, *moment(found))
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), handlelength=2.6)
    return svg(figure, f"{found.scene.title}: error over time")


def draw_headline(scenes: Sequence[SceneFindings]) -> str:
    """A few scenes side by side, with the main variants."""
    figure = Figure(figsize=(WIDTH, 3.7))
    heading(
        figure,
        "Error over time",
        f"Relative L2 error over seconds of processor time. {_MARKS}",
    )
    wide = (WIDTH - _LEFT - _GAP * (len(scenes) - 1) - 0.15) / len(scenes)
    for column, found in enumerate(scenes):
        axes = place(figure, _LEFT + column * (wide + _GAP), 0.95, wide, 1.95)
        names = (FITTED, WALK, ONE_WALK, WHOLE_WALK, SINGLE, CYCLES)
        shown = [found.curves[name] for name in names if name in found.curves]
        _curves(axes, shown, found.resolution, labelled=column == 0)
        _marks(axes, shown, *moment(found))
        axes.set_title(found.scene.title, color=INK, fontsize=8)
        if column == 0:
            handles, labels = axes.get_legend_handles_labels()
            figure.legend(handles, labels, loc="lower center", ncols=len(labels), handlelength=2.6)
    return svg(figure, "Error over time")


def draw_sweeps(found: dict[str, SceneFindings]) -> str | None:
    """Time over the bounce limit, the number of walks and the picture's size.

    None if no sweep was measured over its whole range.
    """
    figure = Figure(figsize=(WIDTH, 3.9))
    heading(
        figure,
        "What bounces, walks and pixels cost",
        "Processor time of a sample; bars: the range of the rounds. Left and middle relative to "
        "the first point.",
    )
    gap = 0.7
    wide = (WIDTH - _LEFT - 2 * gap - 0.15) / 3
    panels = (
        ("Max Bounces", "MaxBounces {}", BOUNCES, ("bounces_showcase", "bounces_slab")),
        ("Walks", "Walks {}", WALK_COUNTS, ("walks_white", "walks_slab")),
        ("Per cent of the showcase's width", "{} %", PERCENTAGES, ("sizes",)),
    )
    for column, (label, form, values, scenes) in enumerate(panels):
        axes = place(figure, _LEFT + column * (wide + gap), _TOP, wide, 2.0)
        for line, name in zip(("-", "--"), scenes, strict=False):
            if name in found:
                _sweep(axes, found[name], form, values, line, relative=column < 2)
        axes.set(xscale="log", xlabel=label)
        axes.set_xticks(values, [str(value) for value in values])
        axes.minorticks_off()
        if column == 2:
            axes.set(yscale="log", ylabel="seconds a sample")
            _plain_numbers(axes.yaxis)
        else:
            axes.set_ylim(bottom=0.0)
        if column == 0:
            axes.set_ylabel("time relative to the first")
        if axes.lines:
            axes.legend(loc="upper left", bbox_to_anchor=(-0.05, -0.22), fontsize=7, ncols=1,
                        handlelength=2.2)  # fmt: skip
    drawn = any(axes.lines for axes in figure.axes)
    return svg(figure, "What bounces, walks and pixels cost") if drawn else None


def note(found: SceneFindings) -> str:
    """A sentence on the reference of the errors."""
    reference = found.scene.reference
    samples = found.scene.reference_samples
    against = {
        "render": f"two renders of Exact, {samples} samples each",
        "white": "radiance 1, which is exact",
    }.get(reference, "the oracle's picture")
    return (
        f"Relative L2 error over {found.pixels} pixels against {against}, at 1, 2, 4 ... samples."
    )


def _curves(axes: Axes, curves: Sequence[Curve], resolution: float, labelled: bool = True) -> None:
    for curve in curves:
        colour, line = COLOURS[curve.variant], LINES.get(curve.variant, "-")
        errors, low, high = (
            [100.0 * math.sqrt(value) for value in some]
            for some in (curve.squared, curve.lowest, curve.highest)
        )
        axes.fill_between(curve.seconds, low, high, color=colour, alpha=0.12, lw=0)
        axes.plot(curve.seconds, errors, line, color=colour, marker="o", ms=2.2,
                  label=curve.variant)  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="seconds of processor time")
    if resolution > 0.0:
        axes.axhline(100.0 * math.sqrt(resolution), color=FAINT, lw=0.6, ls=":")
    if labelled:
        axes.set_ylabel("error in %")
    for axis in (axes.xaxis, axes.yaxis):
        _plain_numbers(axis)


def _plain_numbers(axis: Axis) -> None:
    """Plain numbers along a logarithmic axis, more of them if it is short."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0,) if high / low > 300.0 else (1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _marks(axes: Axes, curves: Sequence[Curve], name: str, seconds: float) -> None:
    """Mark a time, and at each curve how many times smaller its squared error is there.

    name -- the variant that the curves are compared with
    """
    baseline = next((curve for curve in curves if curve.variant == name), None)
    if baseline is None or baseline.error_at(seconds) is None:
        return
    axes.axvline(seconds, color=FAINT, lw=0.6, ls="--")
    axes.annotate(f"than {baseline.variant}", (seconds, 1.0), (3, -2), ("data", "axes fraction"),
                  "offset points", va="top", fontsize=6, color=FAINT)  # fmt: skip
    for curve in curves:
        found = advantage(curve, baseline, seconds)
        if found is None or curve is baseline:
            continue
        level = 100.0 * curve.error_at(seconds)
        axes.plot([seconds], [level], "s", color=COLOURS[curve.variant], ms=3.5)
        if curve.variant in (FITTED, WALK, EXACT, CYCLES):
            axes.annotate(f"{times_text(found)}×", (seconds, level), (4, 3), fontsize=7,
                          textcoords="offset points", color=COLOURS[curve.variant],
                          path_effects=_HALO)  # fmt: skip


def _sweep(
    axes: Axes,
    found: SceneFindings,
    form: str,
    values: Sequence[int],
    line: str,
    relative: bool,
) -> None:
    for quality in COLOURS:
        names = [f"{quality}, {form.format(value)}" for value in values]
        if not all(name in found.curves for name in names):
            continue
        curves = [found.curves[name] for name in names]
        base = curves[0].a_sample if relative else 1.0
        heights = np.array([curve.a_sample for curve in curves]) / base
        spread = np.abs(np.transpose([curve.spread for curve in curves]) / base - heights)
        where = found.scene.title.partition(", ")[2]
        axes.errorbar(values, heights, spread, fmt=f"o{line}", color=COLOURS[quality], ms=2.5,
                      lw=1.0, elinewidth=0.6, label=f"{quality}, {where}")  # fmt: skip
