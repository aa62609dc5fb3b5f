# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plot of error over time, both logarithmic, as steps and then as SVG."""

import html
import math
from dataclasses import dataclass

from .results import CostReport, Measured

WIDTH, HEIGHT = 860, 460
_LEFT, _RIGHT, _TOP, _BOTTOM = 64, 190, 18, 46

# Colour-blind people can tell the first ones apart (Okabe and Ito, 2008); paler ones follow.
COLORS = (
    "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9",
    "#8c8c8c", "#6a51a3", "#a6761d", "#1b9e9e", "#b2182b", "#66a61e",
    "#f4a6c0", "#4a6fe3", "#c7b42c", "#7f3b08",
)  # fmt: skip


# The named colours where no page sets them.
_ALONE = {"ink": "#222", "grid": "#ddd"}


@dataclass(frozen=True)
class Line:
    """Points (x, y) in pixels from the upper left corner; `color` is "#rrggbb" or a name.

    The names are "grid" and "ink", which a page shows darker or lighter.
    """

    points: tuple[tuple[float, float], ...]
    color: str
    width: float = 2.0
    dashed: bool = False


@dataclass(frozen=True)
class Dot:
    """A disc about (x, y)."""

    x: float
    y: float
    color: str
    radius: float = 4.5


@dataclass(frozen=True)
class Label:
    """A text whose baseline is at y; `anchor` is "start", "middle" or "end"."""

    x: float
    y: float
    text: str
    anchor: str = "start"
    color: str = "ink"


def color_of(report: CostReport, variant: Measured) -> str:
    """Return the colour of a variant, the same in all parts of a report."""
    return COLORS[report.variants.index(variant) % len(COLORS)]


def draw_plot(report: CostReport) -> list[Line | Dot | Label]:
    """Return the drawing steps of a report's plot; dots are what was rendered.

    Variants that were too short to be timed are left out, unless all were.
    """
    variants = report.timed or report.variants
    times = [variant.seconds for variant in variants]
    shortest, longest = min(times) / 8.0, max(times) * 8.0
    errors = [v.error_at(t) for v in variants for t in (shortest, longest)]
    low, high = min([*errors, report.setting.error]) / 1.3, max(errors) * 1.3

    def place(time: float, error: float) -> tuple[float, float]:
        right, bottom = WIDTH - _RIGHT, HEIGHT - _BOTTOM
        x = _LEFT + (right - _LEFT) * math.log(time / shortest) / math.log(longest / shortest)
        y = _TOP + (bottom - _TOP) * math.log(high / error) / math.log(high / low)
        return x, y

    steps: list[Line | Dot | Label] = []
    for tick in _ticks(shortest, longest):
        steps.append(Line((place(tick, low), place(tick, high)), "grid", 1.0))
        x, y = place(tick, low)
        steps.append(Label(x, y + 18, f"{tick:g}", "middle"))
    for tick in _ticks(low, high):
        steps.append(Line((place(shortest, tick), place(longest, tick)), "grid", 1.0))
        x, y = place(shortest, tick)
        steps.append(Label(x - 8, y + 4, f"{100 * tick:g} %", "end"))
    target = report.setting.error
    steps.append(Line((place(shortest, target), place(longest, target)), "ink", 1.0, dashed=True))
    steps.append(Label(_LEFT, HEIGHT - 8, "seconds of rendering, without the start"))
    for number, variant in enumerate(v for v in report.ranked() if v in variants):
        color = color_of(report, variant)
        moments = [shortest * (longest / shortest) ** (i / 60) for i in range(61)]
        curve = tuple(place(time, variant.error_at(time)) for time in moments)
        steps += [Line(curve, color), Dot(*place(variant.seconds, variant.error), color)]
        x, y = WIDTH - _RIGHT + 16, _TOP + 12 + 21 * number
        steps += [Dot(x, y - 4, color), Label(x + 12, y, variant.title)]
    return steps


def svg(steps: list[Line | Dot | Label]) -> str:
    """Return the drawing as SVG. A page around it may set the colours of ink and grid."""
    box = f'viewBox="0 0 {WIDTH} {HEIGHT}" font-size="12" font-family="sans-serif"'
    name = 'role="img" aria-label="Error over time"'
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" {box} {name}>']
    for step in steps:
        if isinstance(step, Line):
            points = " ".join(f"{x:.1f},{y:.1f}" for x, y in step.points)
            dashes = ' stroke-dasharray="5 4"' if step.dashed else ""
            parts.append(
                f'<polyline points="{points}" fill="none" stroke-width="{step.width:g}"{dashes} '
                f'style="stroke:{_paint(step.color)}"/>'
            )
        elif isinstance(step, Dot):
            parts.append(
                f'<circle cx="{step.x:.1f}" cy="{step.y:.1f}" r="{step.radius:g}" '
                f'style="fill:{_paint(step.color)}"/>'
            )
        else:
            parts.append(
                f'<text x="{step.x:.1f}" y="{step.y:.1f}" text-anchor="{step.anchor}" '
                f'style="fill:{_paint(step.color)}">{html.escape(step.text)}</text>'
            )
    return "\n".join([*parts, "</svg>"])


def _paint(color: str) -> str:
    return color if color.startswith("#") else f"var(--{color}, {_ALONE[color]})"


def _ticks(low: float, high: float) -> list[float]:
    """Return 1, 2 and 5 times the powers of ten in a range; only the powers if it is wide."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    factors = (1.0,) if high / low > 2000.0 else (1.0, 2.0, 5.0)
    ticks = [float(f"{factor}e{power}") for power in powers for factor in factors]
    return [tick for tick in ticks if low <= tick <= high]
