# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of all tasks, by what they show; and how far apart the columns are."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import numpy as np

from osl.oracle.surface import BECKMANN, GGX

from . import cases
from .cache import Result, Task
from .cases import ALPHAS, MATERIALS, MODELS, SIMULATED, THETAS, TRACKED, Alpha, Effort, LobeFigure
from .estimators import Settled
from .gains import Gain
from .lobes import Lobes, by_lobe
from .masking_curves import MaskingCurve
from .reciprocity import Pairs

Case = tuple[str, str, Alpha]  # model, material and width
Panels = dict[tuple[str, float], Lobes]  # by column and angle


@dataclass(frozen=True)
class Findings:
    """The data of the figures (``masking``, ``lobes``, ``pairs``); the rest is the README's.

    ``finer`` and ``unstretched``: the simulated columns of `cases.CHECKED` on finer sheets and on
    sheets that are not stretched. ``gains`` and ``estimates`` are by case, ``settled`` is by case
    and number of the pair.
    """

    masking: dict[MaskingCurve, Result]
    lobes: dict[LobeFigure, Panels]
    pairs: dict[str, Pairs]
    ggx: dict[Alpha, Panels]
    finer: dict[LobeFigure, Panels]
    unstretched: dict[LobeFigure, Panels]
    gains: dict[Case, Gain]
    estimates: dict[Case, Result]
    settled: dict[tuple[Case, int], tuple[Settled, Result]]

    @classmethod
    def sort(
        cls, found: dict[Task, Result], numbers: Collection[int], effort: Effort
    ) -> "Findings":
        """The data of these figures, from the results of `cases.tasks`.

        The README needs those of `cases.settled` too.
        """
        figures = [figure for figure in cases.LOBE_FIGURES if figure.number in numbers]
        curves = cases.masking_curves(effort) if cases.MASKING in numbers else []
        models = cases.RECIPROCITY_MODELS if cases.RECIPROCITY in numbers else ()
        page = cases.whole(numbers)
        checked = cases.CHECKED if page else ()
        finer, unstretched = (
            {
                figure: _traced_panels([found[task] for task in tasks(effort)], material)
                for material, figure in enumerate(checked)
            }
            for tasks in (cases.finer, cases.unstretched)
        )
        estimators = cases.estimators(effort) if page else {}
        settled = cases.settled(found, effort) if page else {}
        return cls(
            {curve: found[curve] for curve in curves},
            {figure: _figure_panels(figure, found, effort) for figure in figures},
            {
                model: Pairs.merge({task: found[task] for task in cases.reciprocity(model, effort)})
                for model in models
            },
            {
                alpha: _walked_panels(GGX, "conductor", alpha, found, effort)
                for alpha in (ALPHAS if page else ())
            },
            finer,
            unstretched,
            {case: Gain.of(found[task], task.walks) for case, task in estimators.items()},
            {case: found[task] for case, task in estimators.items()},
            {pair: (task, found[task]) for pair, task in settled.items()},
        )


@dataclass(frozen=True)
class Comparison:
    """A ``model`` against a reference column in one case: a material, a width and an angle.

    ``distance`` and ``noise`` ``(LOBES + 1,)`` as `lobe_distance` gives them. ``difference`` and
    ``error`` ``(LOBES, 2)``: E_r and E_t of the model less the reference's, and the standard error
    of that.
    """

    distribution: str
    material: str
    alpha: Alpha
    theta: float
    model: str
    distance: np.ndarray
    noise: np.ndarray
    difference: np.ndarray
    error: np.ndarray

    @property
    def case(self) -> tuple[str, Alpha, float]:
        """Material, alpha and theta."""
        return self.material, self.alpha, self.theta

    @property
    def apart(self) -> float:
        """The distance of all bounces together, less the noise; the squares subtract."""
        return float(np.sqrt(max(self.distance[-1] ** 2 - self.noise[-1] ** 2, 0.0)))


def lobe_distance(a: Lobes, b: Lobes) -> tuple[np.ndarray, np.ndarray]:
    """The share of the light that ``b`` sends elsewhere than ``a``, and the share by noise alone.

    Both are ``(LOBES + 1,)``: by lobe, and last for all lobes together. A distance is half the sum
    over cells of the absolute difference. Noise enlarges it. Half the summed differences between
    the halves scatter as the difference of the means does, but about zero, so they measure the
    noise.
    """
    first, second = _with_all(a.halves), _with_all(b.halves)
    difference = first.mean(axis=0) - second.mean(axis=0)
    noise = 0.5 * ((first[0] - first[1]) + (second[0] - second[1]))
    return 0.5 * np.abs(difference).sum(axis=-1), 0.5 * np.abs(noise).sum(axis=-1)


def to_simulated(found: Findings) -> list[Comparison]:
    """All models of Figs. 5-16 against the simulated surface."""
    return [
        one
        for figure, panels in found.lobes.items()
        for one in _compare(BECKMANN, figure.material, figure.alpha, panels, MODELS, SIMULATED)
    ]


def to_tracked(found: Findings) -> list[Comparison]:
    """The paper's two models against the height-tracked one: Figs. 5-16, and GGX."""
    surfaces = [
        (BECKMANN, figure.material, figure.alpha, panels) for figure, panels in found.lobes.items()
    ] + [(GGX, "conductor", alpha, panels) for alpha, panels in found.ggx.items()]
    ours = [model for model in MODELS if model != TRACKED]
    return [one for surface in surfaces for one in _compare(*surface, ours, TRACKED)]


def _figure_panels(figure: LobeFigure, found: dict[Task, Result], effort: Effort) -> Panels:
    """The lobes of a figure from the results of its tasks."""
    panels = _walked_panels(BECKMANN, figure.material, figure.alpha, found, effort)
    simulated = [found[task] for task in cases.traced(figure.alpha, effort)]
    return panels | _traced_panels(simulated, tuple(MATERIALS).index(figure.material))


def _traced_panels(simulated: list[Result], material: int) -> Panels:
    """The simulated column of the material of that number."""
    return {
        (SIMULATED, theta): Lobes.merge(
            *({name: sums[material, i] for name, sums in one.items()} for one in simulated)
        )
        for i, theta in enumerate(THETAS)
    }


def _walked_panels(
    distribution: str, material: str, alpha: Alpha, found: dict[Task, Result], effort: Effort
) -> Panels:
    return {
        (model, theta): Lobes.merge(
            found[cases.walked(alpha, distribution, material, model, theta, effort)]
        )
        for model in MODELS
        for theta in THETAS
    }


def _compare(
    distribution: str,
    material: str,
    alpha: Alpha,
    panels: Panels,
    models: Iterable[str],
    reference: str,
) -> list[Comparison]:
    found = []
    for theta in THETAS:
        other = panels[reference, theta]
        for model in models:
            mine = panels[model, theta]
            difference = by_lobe(mine.energies.mean - other.energies.mean)
            error = np.sqrt(by_lobe(mine.energies.error**2 + other.energies.error**2))
            case = (distribution, material, alpha, theta, model)
            found.append(Comparison(*case, *lobe_distance(mine, other), difference, error))
    return found


def _with_all(halves: np.ndarray) -> np.ndarray:
    """``halves`` with the sum over lobes as one more, ``(2, LOBES + 1, CELLS)``."""
    return np.concatenate([halves, halves.sum(axis=1, keepdims=True)], axis=1)
