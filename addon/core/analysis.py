# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicts what each step of Quality leaves out of a surface, and proposes the cheapest in limits.

Errors are image L2 of the surface's own light without noise: the root of the summed squared
difference from all bounces over that of all bounces, in the hardest of the lights that were tried.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

from .kinds import KINDS
from .picture_error import limit_of, percent
from .reflectance import Colour
from .step_errors import ANISOTROPIC, ISOTROPIC, STEPS, Interval, cost, left_out, off

QUALITIES = KINDS["CONDUCTOR"].by_identifier["Quality"].choices
MOST_BOUNCES = int(KINDS["CONDUCTOR"].by_identifier["MaxBounces"].legal[1])
FITTED_IORS = (1.05, 2.5)  # of glass; and 1 over them

_SHADER_TOLERANCE = KINDS["CONDUCTOR"].by_identifier["Tolerance"].default
_WALKS = KINDS["CONDUCTOR"].by_identifier["Walks"].default
# Costs as near as this count as one: they were measured no better.
_SAME_COST = 0.02
# And errors as near as this, where all are above the limit.
_SAME_ERROR = 0.1
# What is left out by Max Bounces may take this part of a limit that the step alone breaks.
_PART_OF_BROKEN_LIMIT = 0.1


@dataclass(frozen=True)
class Choice:
    """What is set on a material's node: `quality` is one of QUALITIES."""

    quality: str
    max_bounces: int

    def __str__(self) -> str:
        bounces = "" if self.quality == "Single" else f", {self.max_bounces} bounces"
        return self.quality + bounces


@dataclass(frozen=True)
class Surface:
    """A rough surface whose inputs may vary over it: intervals are (smallest, largest).

    kind          -- "CONDUCTOR", "DIELECTRIC" or "DIFFUSE"
    roughness     -- 0 to 1
    anisotropy    -- 0 to 1
    distributions -- numbers of Distribution that occur
    models        -- numbers of Model that occur
    colour        -- the brightest that is left of light after a bounce, each 0 to 1
    ior           -- of glass
    tolerance     -- the largest Tolerance of the node
    walks         -- Walks of the node
    """

    kind: str
    roughness: Interval = (0.5, 0.5)
    anisotropy: Interval = (0.0, 0.0)
    distributions: tuple[int, ...] = (0,)
    models: tuple[int, ...] = (0,)
    colour: Colour = (1.0, 1.0, 1.0)
    ior: Interval = (1.5, 1.5)
    tolerance: float = _SHADER_TOLERANCE
    walks: int = _WALKS

    @property
    def alphas(self) -> Interval:
        """Smallest and largest value of the larger of both alphas.

        An isotropic surface of that alpha has more light of further bounces.
        """
        return tuple(map(larger_alpha, self.roughness, self.anisotropy))

    @property
    def fitted(self) -> bool:
        """Whether Fitted has a table for some of it."""
        return 0 in self.models and (
            self.kind == "CONDUCTOR"
            or (self.anisotropy[0] == 0.0 and (self.kind != "DIELECTRIC" or _meets(self.ior)))
        )

    @property
    def walked(self) -> bool:
        """Whether Fitted takes Walk for some of it."""
        return (
            not self.fitted
            or self.models != (0,)
            or (self.kind != "CONDUCTOR" and self.anisotropy[1] > 0.0)
            or (self.kind == "DIELECTRIC" and not all(_has_table(ior) for ior in self.ior))
        )


@dataclass(frozen=True)
class Proposal:
    """What is proposed for a surface, and why.

    now, then             -- what is set and what is proposed
    limit                 -- how far off this surface may be
    error_now, error_then -- predicted, as image L2 of its own light
    cost_now, cost_then   -- of a sample, that of metal of alpha 0.25 in Single being 1
    """

    now: Choice
    then: Choice
    share: float
    limit: float
    error_now: float
    error_then: float
    cost_now: float
    cost_then: float
    reason: str

    @property
    def changes(self) -> bool:
        """Whether anything is proposed."""
        return self.now != self.then


def larger_alpha(roughness: float, anisotropy: float) -> float:
    """Return the larger of both alphas, as the shader makes them."""
    return min(roughness * roughness / (1.0 - 0.9 * anisotropy) ** 0.5, 1.0)


@lru_cache(maxsize=64)
def missing_after(surface: Surface) -> tuple[float, ...]:
    """Return what is missing after bounce 1, 2, ... of the surface's own light and colours."""
    white = [
        left_out(surface.kind, distribution, model, surface.alphas, surface.ior)
        for distribution in surface.distributions
        for model in surface.models
    ]
    count = max(map(len, white))
    worst = [max(row[k] if k < len(row) else 0.0 for row in white) for k in range(count)]
    return _coloured(worst, surface.colour)


def predicted_error(surface: Surface, choice: Choice) -> float:
    """Return how far off the surface is with this choice; Exact is off by what it leaves out."""
    bounces = 1 if choice.quality == "Single" else choice.max_bounces
    missing = missing_after(surface)
    ended = _after(missing, bounces)
    if choice.quality == "Exact":
        return ended
    # The errors were measured with the default Tolerance.
    spared = 0.0 if choice.quality == "Single" else surface.tolerance - _SHADER_TOLERANCE
    return _off(surface, choice.quality) + max(ended, min(spared, _after(missing, 1)))


def predicted_cost(surface: Surface, choice: Choice) -> float:
    """Return the cost of a sample; that of metal of alpha 0.25 in Single is 1."""
    single = cost(surface.kind, "Single", surface.alphas)
    walk = cost(surface.kind, "Walk", surface.alphas)
    walk = single + (walk - single) * surface.walks / _WALKS
    fitted = cost(surface.kind, "Fitted", surface.alphas) if surface.fitted else walk
    if surface.walked:
        fitted = max(fitted, walk)
    # Exact makes one walk and has about the time of Single (README, Quality).
    return {"Single": single, "Fitted": fitted, "Walk": walk, "Exact": single}[choice.quality]


def propose(surface: Surface, now: Choice, share: float, count: int, tolerance: float) -> Proposal:
    """Return the cheapest of Single, Fitted and Walk within the limit, with the fewest bounces.

    Where none is within it, it is the cheapest of those that are nearest to it. Fewer bounces save
    time in Walk alone; elsewhere Max Bounces is only raised.
    """
    limit = limit_of(share, count, tolerance)
    missing = missing_after(surface)
    steps = [step for step in STEPS if step != "Fitted" or surface.fitted]
    if now.quality == "Fitted" and not surface.fitted:
        steps[-1] = "Fitted"  # it takes Walk by itself
    choices = [
        Choice(step, _bounces(surface, step, now, missing, limit - _off(surface, step), limit))
        for step in steps
    ]
    errors = {choice: predicted_error(surface, choice) for choice in choices}
    costs = {choice: predicted_cost(surface, choice) for choice in choices}
    good = [choice for choice in choices if errors[choice] <= limit]
    if good:
        # Of steps that cost as much the simplest, which also starts a render sooner.
        least = min(costs[choice] for choice in good)
        then = next(one for one in good if costs[one] <= (1.0 + _SAME_COST) * least)
    else:
        least = min(errors.values())
        near = [one for one in choices if errors[one] <= (1.0 + _SAME_ERROR) * least]
        then = min(near, key=costs.get)
    return Proposal(
        now,
        then,
        share,
        limit,
        predicted_error(surface, now),
        errors[then],
        predicted_cost(surface, now),
        costs[then],
        _reason(surface, then, errors, limit, _after(missing, 1)),
    )


def unchanged(
    surface: Surface, now: Choice, share: float, count: int, tolerance: float, reason: str
) -> Proposal:
    """Return a proposal that leaves everything as it is, for this reason."""
    made = propose(surface, now, share, count, tolerance)
    return replace(
        made, then=now, error_then=made.error_now, cost_then=made.cost_now, reason=reason
    )


def time_ratio(proposals: Sequence[Proposal]) -> float:
    """Return the time of a sample with all proposals over that now; the rest of it costs 1."""
    rest = max(1.0 - sum(one.share for one in proposals), 0.0)
    now = rest + sum(one.share * one.cost_now for one in proposals)
    then = rest + sum(one.share * one.cost_then for one in proposals)
    return then / now if now > 0.0 else 1.0


def _coloured(white: Sequence[float], colour: Colour) -> tuple[float, ...]:
    """Return `missing_after` where each bounce takes on the colour.

    What bounces after the first one add has nearly one shape: their norms add up.
    """
    each = [a - b for a, b in pairwise((1.0, *white, 0.0))]
    channels = [[part * c ** (k + 1) for k, part in enumerate(each)] for c in colour]
    whole = sum(sum(parts) ** 2 for parts in channels) ** 0.5
    if whole == 0.0:
        return (0.0,)
    return tuple(
        sum(sum(parts[k:]) ** 2 for parts in channels) ** 0.5 / whole for k in range(1, len(each))
    )


def _after(missing: Sequence[float], bounces: int) -> float:
    return missing[bounces - 1] if bounces <= len(missing) else 0.0


def _off(surface: Surface, step: str) -> float:
    steps = (step,)
    if step == "Fitted" and surface.walked:
        steps = ("Fitted", "Walk") if surface.fitted else ("Walk",)
    model_names = (None, "height-uncorrelated", "height-tracked")
    sorts = {model_names[model] or ISOTROPIC for model in surface.models}
    if surface.anisotropy[1] > 0.0:
        sorts.add(ANISOTROPIC)
    return max(
        off(surface.kind, distribution, sort, one, surface.alphas)
        for one in steps
        for sort in sorts
        for distribution in surface.distributions
    )


def _bounces(
    surface: Surface,
    step: str,
    now: Choice,
    missing: Sequence[float],
    room: float,
    limit: float,
) -> int:
    if step == "Single":
        return now.max_bounces
    room = max(room, _PART_OF_BROKEN_LIMIT * limit)
    fewest = next((n for n in range(2, MOST_BOUNCES) if _after(missing, n) <= room), MOST_BOUNCES)
    return fewest if step == "Walk" or not surface.fitted else max(fewest, now.max_bounces)


def _reason(
    surface: Surface, then: Choice, errors: dict[Choice, float], limit: float, further: float
) -> str:
    low, high = surface.alphas
    alpha = f"alpha {high:.2g}" if high - low < 0.005 else f"alpha {low:.2g} to {high:.2g}"
    if errors[then] > limit:
        return (
            f"{alpha}: no step is within {percent(limit)}; {then.quality} is nearest with "
            f"{percent(errors[then])}"
        )
    if then.quality == "Single":
        return (
            f"{alpha}: further bounces carry {percent(further)} of its light, within "
            f"{percent(limit)}"
        )
    others = [
        f"{choice.quality} would be {percent(error)} off"
        for choice, error in errors.items()
        if choice != then and error > limit
    ]
    why = f"{', '.join(others)}; " if others else "the cheapest; "
    return f"{alpha}: {why}{then.quality} is within {percent(limit)}"


def _has_table(ior: float) -> bool:
    low, high = FITTED_IORS
    return low <= ior <= high or low <= 1.0 / max(ior, 1e-6) <= high


def _meets(ior: Interval) -> bool:
    """Return whether some index of the interval has a table."""
    low, high = FITTED_IORS
    return (ior[0] <= high and ior[1] >= low) or (ior[0] <= 1.0 / low and ior[1] >= 1.0 / high)
