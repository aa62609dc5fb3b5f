# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Figs. 5-16: the lobes of the individual bounces, a panel for each angle and column."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from .cases import COLUMNS, SIMULATED, THETAS, LobeFigure
from .draw import BOUNCE_COLOURS, FAINT, INK, WIDTH, heading, label, place, svg
from .lobes import LOBE_NAMES, LOBES, PLANE_WIDTH, Lobes, by_lobe, plane_angles

_LEFT, _TOP, _RIGHT, _GAP = 0.72, 1.06, 0.08, 0.14  # inches
_PANEL = (WIDTH - _LEFT - _RIGHT - (len(COLUMNS) - 1) * _GAP) / len(COLUMNS)
_TALLEST = 1.9  # a panel, in inches
_LINE = 0.17  # of the numbers under a panel
_ROW_GAP = 0.24
_ARROW = 0.32
_WIDE = 1.0  # radians; a wider lobe is drawn with half the points
_FAINTEST = 2e-4  # a lobe of less energy would be a dot

_HEADS = {
    "uncorrelated": "Uncorrelated",
    "correlated": "Correlated",
    "height-tracked": "Height-tracked (Heitz 2016)",
    SIMULATED: "Simulated surface",
}

Outline = tuple[int, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class _Box:
    """What is shown of the plane of incidence: |x| up to ``half``, z from -``down`` to ``up``."""

    half: float
    up: float
    down: float

    @property
    def scale(self) -> float:
        """Inches a unit."""
        return _PANEL / (2.0 * self.half)

    @property
    def height(self) -> float:
        """Of a panel, in inches."""
        return self.scale * (self.up + self.down)

    @classmethod
    def around(cls, outlines: Iterable[Outline], half: float = 0.0) -> "_Box":
        """The box of lobes, the arrow and the Lambertian lobe; at least ``half`` to each side."""
        x, z = (np.concatenate(one) for one in zip(*(one[1:] for one in outlines), strict=True))
        half = max(half, 1.08 * np.abs(x).max())
        up, down = max(1.06 * z.max(), 1.04 * np.sqrt(0.5), 0.5 * half), -1.06 * z.min()
        half = max(half, 0.5 * _PANEL * (up + down) / _TALLEST)
        return cls(half, up, max(down, 0.02 * half))


def draw(figure: LobeFigure, panels: dict[tuple[str, float], Lobes]) -> str:
    """The figure as SVG; ``panels`` by column and angle."""
    outlines = {where: list(_outlines(lobes)) for where, lobes in panels.items()}
    rows = [[one for column in COLUMNS for one in outlines[column, theta]] for theta in THETAS]
    half = max(_Box.around(row).half for row in rows)  # all rows get the same scale
    boxes = [_Box.around(row, half) for row in rows]
    lines = 2 if figure.transmits else 1
    steps = [box.height + lines * _LINE + _ROW_GAP for box in boxes]
    page = Figure(figsize=(WIDTH, _TOP + sum(steps)))
    heading(
        page,
        f"Fig. {figure.number}: {figure.title}",
        "Where light leaves, by angle in the plane of incidence. Areas are proportional to energy; "
        "dotted: a Lambertian surface.",
    )
    _legend(page)
    for i, column in enumerate(COLUMNS):
        left = _LEFT + i * (_PANEL + _GAP)
        label(page, left + 0.5 * _PANEL, _TOP - 0.14, _HEADS[column], size=9, ha="center")
        for row, (theta, box) in enumerate(zip(THETAS, boxes, strict=True)):
            top = _TOP + sum(steps[:row])
            if i == 0:
                label(page, 0.15, top + box.scale * box.up, f"θ = {theta:g}")
            _panel(place(page, left, top, _PANEL, box.height), outlines[column, theta], theta, box)
            below = place(page, left, top + box.height + 0.02, _PANEL, lines * _LINE)
            _numbers(below, panels[column, theta], lines)
    return svg(page, f"Fig. {figure.number}: {figure.title}")


def _legend(page: Figure) -> None:
    """The colours of the bounces."""
    label(page, 0.15, 0.68, "bounce")
    axes = place(page, 0.0, 0.58, WIDTH, 0.2)
    axes.set(xlim=(0.0, WIDTH), ylim=(0.0, 0.2))
    axes.axis("off")
    for i, (colour, text) in enumerate(zip(BOUNCE_COLOURS, LOBE_NAMES, strict=True)):
        at = _LEFT + 0.45 * i
        _fill(axes, [at, at + 0.16, at + 0.16, at], [0.04, 0.04, 0.16, 0.16], colour)
        label(page, at + 0.21, 0.68, text, color=colour, weight="bold")


def _panel(axes: Axes, outlines: list[Outline], theta: float, box: _Box) -> None:
    """The lobes of one panel, the surface as a line and the light as an arrow."""
    axes.set(xlim=(-box.half, box.half), ylim=(-box.down, box.up))
    axes.axis("off")
    axes.axhline(0.0, color=FAINT, lw=0.8, zorder=1)
    psi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 31)
    lambertian = np.sqrt(0.5 * np.cos(psi))
    axes.plot(
        lambertian * np.sin(psi), lambertian * np.cos(psi), color=FAINT, lw=0.7, ls=":", zorder=1
    )
    for lobe, x, z in outlines:
        _fill(axes, x, z, BOUNCE_COLOURS[lobe], zorder=2 + lobe)
    towards = np.array([-np.sin(theta), np.cos(theta)])
    far = 0.98 * np.min(np.array([box.half, box.up]) / np.maximum(np.abs(towards), 1e-9))
    axes.annotate(
        "",
        xy=tuple((far - _ARROW / box.scale) * towards),
        xytext=tuple(far * towards),
        arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.0, "mutation_scale": 7},
        zorder=9,
    )


def _fill(axes: Axes, x: np.ndarray, y: np.ndarray, colour: str, **options: float) -> None:
    axes.fill(x, y, facecolor=to_rgba(colour, 0.16), edgecolor=colour, clip_on=False, **options)


def _outlines(lobes: Lobes) -> Iterator[Outline]:
    """Closed curves of the lobes on either side of the surface: number of the lobe, x and z.

    The radius is the square root of the energy per radian. Faint lobes are left out.
    """
    psi = plane_angles()
    for lobe in range(LOBES):
        for side in (1.0, -1.0):
            mine = np.flatnonzero(side * np.cos(psi) > 0.0)
            if side < 0.0:  # in the order of angles, across psi = pi
                mine = np.roll(mine, -mine.size // 2)
            energy = lobes.plane.mean[lobe, mine] * PLANE_WIDTH
            if energy.sum() < _FAINTEST:
                continue
            x, z = np.sin(psi[mine]), np.cos(psi[mine])
            width = PLANE_WIDTH
            if energy.sum() ** 2 / (energy**2).sum() * width > _WIDE:  # half the points will do
                x, z, energy = (one[::2] + one[1::2] for one in (x, z, energy))
                x, z, width = 0.5 * x, 0.5 * z, 2.0 * width
            used = np.flatnonzero(energy > 1e-5 * energy.max())
            some = slice(used[0], used[-1] + 1)
            radius = np.sqrt(energy[some] / width)
            yield lobe, np.append(radius * x[some], 0.0), np.append(radius * z[some], 0.0)


def _numbers(axes: Axes, lobes: Lobes, lines: int) -> None:
    """E_r, and E_t if ``lines`` is 2: in total, and by bounce in the bounces' colours."""
    axes.set(xlim=(0.0, 1.0), ylim=(lines, 0.0))
    axes.axis("off")
    for line in range(lines):
        style = {"y": line + 0.5, "va": "center", "size": 7.5}
        axes.text(0.0, s=f"$E_{'rt'[line]}$", color=INK, **style)
        total = f"{lobes.total.mean[line]:.3f}"
        axes.text(0.235, s=total, color=INK, ha="right", weight="bold", **style)
        for lobe, part in enumerate(by_lobe(lobes.energies.mean)[:, line]):
            colour = BOUNCE_COLOURS[lobe] if part >= 5e-4 else FAINT
            text = f"{part:.3f}".removeprefix("0")
            axes.text(0.405 + 0.149 * lobe, s=text, color=colour, ha="right", **style)
