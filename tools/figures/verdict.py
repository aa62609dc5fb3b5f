# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of the README that say what the figures show, in words that depend on the data."""

from collections.abc import Callable, Iterable

import numpy as np

from osl.oracle.surface import BECKMANN, GGX

from .cases import ALPHAS, COLUMNS, MATERIALS, MODELS, SIMULATED, THETAS, TRACKED, alpha_text
from .findings import Comparison, Findings
from .lobes import LOBE_NAMES, by_lobe
from .markdown import in_words, percent, table

AGREES = 0.02  # a model agrees if it sends at most this share of the light elsewhere
FAR = 0.1  # more than this share elsewhere is worth a table
OURS = ("correlated", "uncorrelated")  # the paper's models

_GRAZING = THETAS[-1]


def agreement(comparisons: list[Comparison]) -> str:
    """The cases in which the models agree with the simulated surface, and those in which not."""
    every = list(dict.fromkeys(one.case for one in comparisons))
    agree = {
        model: {one.case for one in comparisons if one.model == model and one.apart <= AGREES}
        for model in MODELS
    }
    everyone = [case for case in every if all(case in some for some in agree.values())]
    nobody = [case for case in every if not any(case in some for some in agree.values())]
    counts = ", ".join(f"the {model} model in {len(agree[model])}" for model in MODELS)
    groups: list[tuple[str, Callable[[Comparison], bool]]] = [("all", lambda one: True)]
    groups += [(f"θ = {theta:g}", lambda one, t=theta: one.theta == t) for theta in THETAS]
    groups += [(alpha_text(alpha), lambda one, a=alpha: one.alpha == a) for alpha in ALPHAS]
    groups += [(material, lambda one, m=material: one.material == m) for material in MATERIALS]
    return f"""## Where the models agree with the simulated surface

A model is said to agree in a case (a material, an α and a θ) when it sends at most
{100 * AGREES:g} % of the light elsewhere, all bounces together. Of the {len(every)} cases that is
{counts}.

- All three agree: {in_words(everyone)}.
- None agrees: {in_words(nobody)}.

Distance from the simulated surface in per cent of the light, mean over the cases (and largest):

{table(("cases", *MODELS), [(text, *_means(comparisons, MODELS, some)) for text, some in groups])}

Case by case, {" / ".join(MODELS)}:

{_by_case(comparisons, MODELS)}"""


def largest(found: Findings, comparisons: list[Comparison]) -> str:
    """The cases in which a model is far from the simulated surface, by bounce."""
    far = list(dict.fromkeys(one.case for one in comparisons if one.apart > FAR))
    worst = max(comparisons, key=lambda one: one.apart)
    text = f"""### The largest differences

The largest distance is {percent(worst.apart)} % of the light, {worst.model},
{in_words([worst.case])}.
A model sends more than {100 * FAR:g} % elsewhere in: {in_words(far)}."""
    if not far:
        return text
    shown = [one for one in comparisons if one.case in far]
    rows, late = [], []
    for case in far:
        material, alpha, theta = case
        panels = next(
            panels
            for figure, panels in found.lobes.items()
            if (figure.material, figure.alpha) == (material, alpha)
        )
        through = panels[SIMULATED, theta].energies.mean[:, 1]
        if MATERIALS[material].transmits:
            late.append(through[1:].sum() / through.sum())
        apart = {one.model: percent(one.apart) for one in shown if one.case == case}
        for column in COLUMNS:
            energies = by_lobe(panels[column, theta].energies.mean)
            rows.append(
                (
                    in_words([case]),
                    column,
                    f"{energies[:, 0].sum():.3f}",
                    f"{energies[:, 1].sum():.3f}",
                    *(f"{one:.3f}" for one in energies[:, 1]),
                    apart.get(column, ""),
                )
            )
    header = "", "column", "E_r", "E_t", *(f"E_t {k}" for k in LOBE_NAMES), "distance in %"
    return f"""{text}

{_through([one for one in shown if MATERIALS[one.material].transmits], late)}

{table(header, rows)}"""


def _through(shown: list[Comparison], late: list[float]) -> str:
    """Why the models share out transmitted light differently, with these cases' numbers.

    ``late``: the shares of the transmitted light that the simulated surface sends after bounce 1.
    """
    if not shown:
        return "They are all cases in which no light goes through."

    def of(model: str, bounce: int) -> str:
        values = [one.difference[bounce - 1, 1] for one in shown if one.model == model]
        return " and ".join(f"{value:+.3f}".replace("-", "−") for value in values)

    near = [one for one in shown if one.model == OURS[0]]
    share = [one.distance[1] / one.distance[:-1].sum() for one in near]
    tracked = min(one.apart for one in shown if one.model == TRACKED)
    height = "is not for want of" if tracked > AGREES else "is for want of"
    return f"""Where light goes through, E_t at the first bounce is off the simulated surface's by
{of("uncorrelated", 1)} in the uncorrelated model, and at the second by {of("uncorrelated", 2)}.
Grazing light meets high parts of the surface, and behind them has nearly all its depth still to
pass: on the simulated surface {_range(late)} % of what goes through meets it once more. The
uncorrelated model takes the chance to leave as if the light were at any height. The correlated
model knows that the height is the same on both sides; it is off by {of("correlated", 1)}, and at
the second bounce by {of("correlated", 2)}, the height-tracked one by {of(TRACKED, 1)} and by
{of(TRACKED, 2)}, so what is left {height} the height. Of the correlated model's distance, taken
bounce by bounce, {_range(share)} % is at the second bounce: slopes and heights along its way are
independent in Smith's theory, and on a continuous surface they are not."""


def _range(shares: list[float]) -> str:
    """Least and largest of some shares in per cent, whole."""
    return " to ".join(dict.fromkeys(f"{100.0 * one:.0f}" for one in (min(shares), max(shares))))


def bounces(found: Findings) -> str:
    """The light by bounce."""
    opaque = [panels for figure, panels in found.lobes.items() if not figure.transmits]

    def first(column: str) -> np.ndarray:
        return np.array([panels[column, _GRAZING].energies.mean[0, 0] for panels in opaque])

    surplus = first(SIMULATED) - first(TRACKED)
    rows = [
        (
            f"θ = {theta:g}",
            text,
            *(
                f"{np.mean([one[column, theta].energies.mean[part].sum() for one in opaque]):.4f}"
                for column in (*MODELS, SIMULATED)
            ),
        )
        for theta in THETAS
        for text, part in (("first", slice(0, 1)), ("fourth and later", slice(3, None)))
    ]
    return f"""### By bounce

In grazing light, θ = {_GRAZING:g}, more leaves the simulated surface at the first bounce than
leaves the height-tracked model in {np.sum(surplus > 0.0)} of the {surplus.size} opaque cases; the
difference is {surplus.min():+.3f} to {surplus.max():+.3f} of the light. Smith's theory takes the
heights and slopes that a ray passes for independent of each other, which they are not on a
continuous surface. Energy that leaves at a bounce, mean over the opaque surfaces:

{table(("", "bounce", *MODELS, SIMULATED), rows)}"""


def claim(comparisons: list[Comparison]) -> str:
    """The supplement's claim about its models and the height-tracked one."""
    beckmann = [one for one in comparisons if one.distribution == BECKMANN]
    ggx = [one for one in comparisons if one.distribution == GGX]
    near, far = ([one for one in beckmann if one.model == model] for model in OURS)
    both = list(zip(near, far, strict=True))
    margins = [(a, b.apart - a.apart, max(a.noise[-1], b.noise[-1])) for a, b in both]
    farther = [a for a, more, noise in margins if more > noise]
    closer = [a for a, more, noise in margins if more < -noise]
    count = len(near) // len(THETAS)

    def at(some: list[Comparison], theta: float) -> int:
        return sum(one.theta == theta for one in some)

    worst, worst_ggx = (
        max((one for one in some if one.model == "correlated"), key=lambda one: one.apart)
        for some in (beckmann, ggx)
    )
    middle = np.median([one.apart for one in near])
    similar = sum(one.apart <= AGREES for one in near)
    rows = [
        (
            f"θ = {theta:g}",
            *_means(beckmann, OURS, lambda one, t=theta: one.theta == t),
            f"{at(farther, theta)} of {count}",
            f"{at(closer, theta)} of {count}",
        )
        for theta in THETAS
    ]
    return f"""## The correlated model and Heitz et al. (2016)

The supplement says that at all angles its correlated model gives very similar results to Heitz et
al. (here: height-tracked), and that its uncorrelated model differs more, mostly at grazing angles.

- The first part {_holds(similar, len(near))}: with Beckmann the correlated model sends at most
  {100 * AGREES:g} % of the light elsewhere in {similar} of {len(near)} cases. It is
  {percent(middle)} % in the median case, and {percent(worst.apart)} % in the worst,
  {in_words([worst.case])}.
- The second part {_holds(at(farther, _GRAZING), count)} at θ = {_GRAZING:g}, where the uncorrelated
  model is farther off, by more than the noise, in {at(farther, _GRAZING)} of {count} cases. At all
  angles together it is that in {len(farther)} of {len(near)}, and nearer in {len(closer)}:
  {in_words(one.case for one in closer)}.
- With GGX, which the supplement's figures leave out, the correlated model is off by up to
  {percent(worst_ggx.apart)} % ({in_words([worst_ggx.case])}).

Distance from the height-tracked model in per cent of the light, mean (and largest):

{table(("Beckmann", *OURS, "uncorrelated is farther off in", "nearer in"), rows)}

GGX, white conductor, {" / ".join(OURS)}. There is no simulated surface of GGX here: the height
fields are Gaussian. Energies: [ggx_energies.csv](ggx_energies.csv).

{_by_case(ggx, OURS)}"""


def _holds(count: int, of: int) -> str:
    """The verdict on a claim that is right in ``count`` cases ``of`` all."""
    if count == of:
        return "is confirmed"
    return "holds in most cases" if 2 * count > of else "is contradicted"


def _means(
    comparisons: list[Comparison], models: Iterable[str], chosen: Callable[[Comparison], bool]
) -> list[str]:
    """Mean and largest distance over the chosen cases, for each model."""
    texts = []
    for model in models:
        values = [one.apart for one in comparisons if one.model == model and chosen(one)]
        texts.append(f"{percent(np.mean(values))} ({percent(max(values))})")
    return texts


def _by_case(comparisons: list[Comparison], models: Iterable[str]) -> str:
    """A table of surfaces by angles, with the distances of the models."""
    apart = {(*one.case, one.model): percent(one.apart) for one in comparisons}
    surfaces = dict.fromkeys((one.material, one.alpha) for one in comparisons)
    rows = [
        (
            f"{surface[0]}, {alpha_text(surface[1])}",
            *(" / ".join(apart[*surface, theta, model] for model in models) for theta in THETAS),
        )
        for surface in surfaces
    ]
    return table(("", *(f"θ = {theta:g}" for theta in THETAS)), rows)
