# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures show, and the tasks that compute their data."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from osl.oracle.materials import Conductor, Dielectric, Diffuse, Material
from osl.oracle.surface import BECKMANN, CORRELATED, GGX, HEIGHT_TRACKED, UNCORRELATED, Surface

from .cache import Result, Task
from .estimators import Estimators, Settled
from .gains import FAR, z_scores
from .masking_curves import MaskingCurve
from .reciprocity import Reciprocity
from .traced import RESOLUTION, Traced
from .walked import Walked

Alpha = tuple[float, float]

MATERIALS: dict[str, Material] = {
    "diffuse": Diffuse(),
    "conductor": Conductor(),
    "dielectric": Dielectric(1.5),
}
ALPHAS: tuple[Alpha, ...] = ((0.25, 0.25), (0.5, 0.5), (1.0, 1.0), (1.0, 0.1))
THETAS = (0.0, 0.5, 1.0, 1.5)  # radians from the normal

TRACKED, SIMULATED = "height-tracked", "simulated"  # the columns that others are compared with
MODELS = {"uncorrelated": UNCORRELATED, "correlated": CORRELATED, TRACKED: HEIGHT_TRACKED}
COLUMNS = (*MODELS, SIMULATED)

MASKING = 2  # numbers of the supplement's figures
RECIPROCITY = 17


@dataclass(frozen=True)
class Effort:
    """How much is computed.

    ``walks`` on each model. ``sheets`` of ``cells`` squared, in groups of ``group`` (even), with
    ``rays`` on each, and ``fine`` sheets (even) of twice the resolution. ``pairs`` of directions in
    chunks of ``chunk``, with ``pair_walks`` each. ``angles`` of a masking curve. ``estimates``: the
    pairs for both estimators, and the walks of each. ``settle``: the walks, one-way and
    bidirectional, that settle a pair.
    """

    walks: int
    sheets: int
    group: int
    rays: int
    cells: int
    fine: int
    pairs: int
    chunk: int
    pair_walks: int
    angles: int
    estimates: tuple[int, int]
    settle: tuple[int, int]


FULL = Effort(
    walks=1 << 21,
    sheets=64,
    group=8,
    rays=1 << 15,
    cells=512,
    fine=16,
    pairs=1024,
    chunk=64,
    pair_walks=8192,
    angles=180,
    estimates=(64, 8192),
    settle=(3_000_000, 40_000),
)
QUICK = Effort(
    walks=1 << 12,
    sheets=4,
    group=4,
    rays=1 << 9,
    cells=64,
    fine=2,
    pairs=64,
    chunk=64,
    pair_walks=256,
    angles=36,
    estimates=(8, 64),
    settle=(512, 64),
)


@dataclass(frozen=True)
class LobeFigure:
    """One of Figs. 5-16: a material and a width, for all angles and columns."""

    number: int
    material: str
    alpha: Alpha

    @property
    def transmits(self) -> bool:
        """Whether light goes through the surface."""
        return MATERIALS[self.material].transmits

    @property
    def title(self) -> str:
        """What the figure shows."""
        kind = f"{self.material}, IOR 1.5" if self.transmits else f"white {self.material}"
        return f"Rough {kind}, Beckmann, {alpha_text(self.alpha)}"


LOBE_FIGURES = tuple(
    LobeFigure(5 + 4 * i + j, material, alpha)
    for i, material in enumerate(MATERIALS)
    for j, alpha in enumerate(ALPHAS)
)
CHECKED = tuple(one for one in LOBE_FIGURES if one.number in (11, 15))  # both have alpha 1
NUMBERS = (MASKING, *(figure.number for figure in LOBE_FIGURES), RECIPROCITY)

MASKING_SURFACES = tuple(
    Surface(alpha, alpha, distribution)
    for distribution in (GGX, BECKMANN)
    for alpha in (1.0, 0.5, 0.25)
)
RECIPROCITY_MODELS = ("uncorrelated", "correlated")


def name(number: int) -> str:
    """Start of the names of a figure's files."""
    return f"fig{number:02}"


def alpha_text(alpha: Alpha) -> str:
    """``α = 0.5``, or ``α = (1, 0.1)`` if the surface is anisotropic."""
    x, y = alpha
    return f"α = {x:g}" if x == y else f"α = ({x:g}, {y:g})"


def walked(
    alpha: Alpha, distribution: str, material: str, model: str, theta: float, effort: Effort
) -> Walked:
    """The task of one panel of a model's column."""
    surface = Surface(*alpha, distribution, MATERIALS[material], MODELS[model])
    return Walked(surface, theta, effort.walks)


def traced(alpha: Alpha, effort: Effort) -> list[Traced]:
    """The tasks of the simulated columns of all materials at ``alpha``."""
    sheets = range(effort.sheets)
    return [
        Traced(
            alpha,
            tuple(MATERIALS.values()),
            THETAS,
            tuple(sheets[first : first + effort.group]),
            effort.rays,
            effort.cells,
        )
        for first in range(0, effort.sheets, effort.group)
    ]


def finer(effort: Effort) -> list[Traced]:
    """The tasks that show the effect of the facets' size: `CHECKED` on finer sheets."""
    finest = replace(_checked(effort)[0], cells=2 * effort.cells, resolution=2.0 * RESOLUTION)
    pairs = zip(range(0, effort.fine, 2), range(1, effort.fine, 2), strict=True)
    return [replace(finest, sheets=pair) for pair in pairs]


def unstretched(effort: Effort) -> list[Traced]:
    """The tasks that show the effect of stretching the sheets: `CHECKED` without it."""
    return [replace(task, stretched=False) for task in _checked(effort)]


def _checked(effort: Effort) -> list[Traced]:
    """The tasks of the simulated columns of `CHECKED` alone."""
    materials = tuple(MATERIALS[figure.material] for figure in CHECKED)
    return [replace(task, materials=materials) for task in traced(CHECKED[0].alpha, effort)]


def masking_curves(effort: Effort) -> list[MaskingCurve]:
    """The tasks of Fig. 2."""
    return [MaskingCurve(surface, effort.angles) for surface in MASKING_SURFACES]


def reciprocity(model: str, effort: Effort) -> list[Reciprocity]:
    """The tasks of Fig. 17, one model: a white rough conductor, GGX, alpha = 1."""
    surface = Surface(1.0, 1.0, GGX, MATERIALS["conductor"], MODELS[model])
    return [
        Reciprocity(surface, first, effort.chunk, effort.pair_walks)
        for first in range(0, effort.pairs, effort.chunk)
    ]


def ggx(effort: Effort) -> list[Walked]:
    """The tasks of the comparison of the models for GGX, a white conductor."""
    return [
        walked(alpha, GGX, "conductor", model, theta, effort)
        for alpha in ALPHAS
        for model in MODELS
        for theta in THETAS
    ]


def estimators(effort: Effort) -> dict[tuple[str, str, Alpha], Estimators]:
    """The tasks that compare the walk with the bidirectional estimator, by model, material, alpha.

    They take GGX, which has more energy after the first bounce.
    """
    return {
        (model, material, alpha): Estimators(
            Surface(*alpha, GGX, MATERIALS[material], MODELS[model]), *effort.estimates
        )
        for model in RECIPROCITY_MODELS
        for material in MATERIALS
        for alpha in ((0.25, 0.25), (1.0, 1.0))
    }


def settled(
    found: dict[Task, Result], effort: Effort
) -> dict[tuple[tuple[str, str, Alpha], int], Settled]:
    """The tasks for pairs whose values by `estimators` are far apart, by case and pair number."""
    return {
        (case, int(pair)): Settled(task, int(pair), *effort.settle)
        for case, task in estimators(effort).items()
        for pair in np.flatnonzero(np.abs(z_scores(found[task])) > FAR)
    }


def whole(numbers: Collection[int]) -> bool:
    """Whether these are all figures, so that the README can be made."""
    return set(numbers) == set(NUMBERS)


def tasks(numbers: Collection[int], effort: Effort) -> list[Task]:
    """All tasks of these figures, and of the README if these are all figures."""
    found: list[Task] = masking_curves(effort) if MASKING in numbers else []
    for figure in LOBE_FIGURES:
        if figure.number in numbers:
            found += [
                walked(figure.alpha, BECKMANN, figure.material, model, theta, effort)
                for model in MODELS
                for theta in THETAS
            ]
            found += traced(figure.alpha, effort)
    if RECIPROCITY in numbers:
        found += [task for model in RECIPROCITY_MODELS for task in reciprocity(model, effort)]
    if whole(numbers):
        found += [*ggx(effort), *finer(effort), *unstretched(effort), *estimators(effort).values()]
    return found
