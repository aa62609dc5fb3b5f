# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures say, in words that depend on the data."""

from collections.abc import Callable, Iterable

import numpy as np

from blender_tests.oracle.surface import BECKMANN, GGX

from .cases import ALPHAS, MATERIALS, MODELS, SIMULATED, THETAS, TRACKED, alpha_text
from .findings import Comparison, Findings
from .markdown import cases, percent, table

AGREES = 0.02  # a model that sends at most this share of the light elsewhere is said to agree
OURS = ("correlated", "uncorrelated")  # the paper's models

_GRAZING = THETAS[-1]


def agreement(comparisons: list[Comparison]) -> str:
    """Where the models agree with the simulated surface, and where they do not."""
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

- All three agree: {cases(everyone)}.
- None agrees: {cases(nobody)}.

Distance from the simulated surface in per cent of the light, mean over the cases (and largest):

{table(("cases", *MODELS), [(text, *_means(comparisons, MODELS, some)) for text, some in groups])}

Case by case, {" / ".join(MODELS)}:

{_by_case(comparisons, MODELS)}"""


def bounces(found: Findings) -> str:
    """How the light is shared out among the bounces."""
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
  {cases([worst.case])}.
- The second part {_holds(at(farther, _GRAZING), count)} at θ = {_GRAZING:g}, where the uncorrelated
  model is farther off, by more than the noise, in {at(farther, _GRAZING)} of {count} cases. At all
  angles together it is that in {len(farther)} of {len(near)}, and nearer in {len(closer)}:
  {cases(one.case for one in closer)}.
- With GGX, which the supplement's figures leave out, the correlated model is off by up to
  {percent(worst_ggx.apart)} % ({cases([worst_ggx.case])}).

Distance from the height-tracked model in per cent of the light, mean (and largest):

{table(("Beckmann", *OURS, "uncorrelated is farther off in", "nearer in"), rows)}

GGX, white conductor, {" / ".join(OURS)}. There is no simulated surface of GGX here: the height
fields are Gaussian. Energies: [ggx_energies.csv](ggx_energies.csv).

{_by_case(ggx, OURS)}"""


def _holds(count: int, of: int) -> str:
    """What to say of a claim that is right in ``count`` cases."""
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
