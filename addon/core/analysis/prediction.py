# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicts the error and the cost of each Quality for a surface, and what decides on Walk for
Fitted.

Errors are image L2 of the surface's own light without noise: the root of the summed squared
difference from all bounces over that of all bounces. They hold for the hardest of the measured
lights.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from ..parameters import SHARED
from .reflectance import Colour
from .step_errors import ANISOTROPIC, ISOTROPIC, Interval, cost, left_out, off

QUALITIES = SHARED["Quality"].choices
MOST_BOUNCES = int(SHARED["MaxBounces"].legal[1])
FITTED_IORS = (1.05, 2.5)  # of glass; and 1 over them

_SHADER_TOLERANCE = SHARED["Tolerance"].default
_WALKS = SHARED["Walks"].default


@dataclass(frozen=True)
class Choice:
    """The settings of a material's node; `quality` is one of QUALITIES."""

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
    colour        -- the largest part of light left after a bounce, each channel 0 to 1
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

        An isotropic surface of that alpha has more light in further bounces.
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


def larger_alpha(roughness: float, anisotropy: float) -> float:
    """Return the larger of both alphas, as the shader computes it from roughness."""
    return min(roughness * roughness / (1.0 - 0.9 * anisotropy) ** 0.5, 1.0)


@lru_cache(maxsize=128)
def missing_after(surface: Surface, of: str = "left_out") -> tuple[float, ...]:
    """Return what is missing after bounce 1, 2, ... of the surface's own light and colours.

    It is image L2, or energy if `of` is "lost".
    """
    white = [
        left_out(surface.kind, distribution, model, surface.alphas, surface.ior, of)
        for distribution in surface.distributions
        for model in surface.models
    ]
    count = max(map(len, white))
    worst = [max(row[k] if k < len(row) else 0.0 for row in white) for k in range(count)]
    return _coloured(worst, surface.colour)


def predicted_loss(surface: Surface, choice: Choice) -> float:
    """Return the part of the surface's light, as energy, that this choice leaves out."""
    return _after(missing_after(surface, "lost"), _bounces_of(choice))


def predicted_error(surface: Surface, choice: Choice) -> float:
    """Return the error of the surface with this choice. Exact is off by what it leaves out."""
    missing = missing_after(surface)
    ended = _after(missing, _bounces_of(choice))
    if choice.quality == "Exact":
        return ended
    # The errors were measured with the default Tolerance.
    spared = 0.0 if choice.quality == "Single" else surface.tolerance - _SHADER_TOLERANCE
    return _off(surface, choice.quality) + max(ended, min(spared, _after(missing, 1)))


def predicted_cost(surface: Surface, choice: Choice) -> float:
    """Return the cost of a sample. Metal of alpha 0.25 in Single costs 1."""
    single = cost(surface.kind, "Single", surface.alphas)
    walk = cost(surface.kind, "Walk", surface.alphas)
    walk = single + (walk - single) * surface.walks / _WALKS
    fitted = cost(surface.kind, "Fitted", surface.alphas) if surface.fitted else walk
    if surface.walked:
        fitted = max(fitted, walk)
    # Exact makes one walk and has about the time of Single (docs/cost.md, Quality).
    return {"Single": single, "Fitted": fitted, "Walk": walk, "Exact": single}[choice.quality]


def fewest_bounces(surface: Surface, room: float) -> int:
    """Return the smallest Max Bounces, of 2 or more, that leaves out no more than `room`."""
    missing = missing_after(surface)
    return next((n for n in range(2, MOST_BOUNCES) if _after(missing, n) <= room), MOST_BOUNCES)


def _coloured(white: Sequence[float], colour: Colour) -> tuple[float, ...]:
    """Return `missing_after` with the colour of each bounce.

    Bounces after the first have nearly the same shape, so their norms add up.
    """
    each = [a - b for a, b in pairwise((1.0, *white, 0.0))]
    channels = [[part * c ** (k + 1) for k, part in enumerate(each)] for c in colour]
    whole = sum(sum(parts) ** 2 for parts in channels) ** 0.5
    if whole == 0.0:
        return (0.0,)
    return tuple(
        sum(sum(parts[k:]) ** 2 for parts in channels) ** 0.5 / whole for k in range(1, len(each))
    )


def _bounces_of(choice: Choice) -> int:
    return 1 if choice.quality == "Single" else choice.max_bounces


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


def _has_table(ior: float) -> bool:
    low, high = FITTED_IORS
    return low <= ior <= high or low <= 1.0 / max(ior, 1e-6) <= high


def _meets(ior: Interval) -> bool:
    """Return whether some index of the interval has a table."""
    low, high = FITTED_IORS
    return (ior[0] <= high and ior[1] >= low) or (ior[0] <= 1.0 / low and ior[1] >= 1.0 / high)
