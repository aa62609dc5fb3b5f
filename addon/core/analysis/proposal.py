# SPDX-License-Identifier: GPL-3.0-or-later
"""Proposes the cheapest Quality of every surface that keeps the picture within a tolerance.

All surfaces start with their cheapest step. Then the change that lowers the squared error most for
its time is made, until the picture is within the tolerance.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .picture_error import equal_part, percent, picture_error
from .prediction import (
    QUALITIES,
    Choice,
    Surface,
    fewest_bounces,
    predicted_cost,
    predicted_error,
    predicted_loss,
)
from .step_errors import STEPS, background

# Costs closer than this count as equal, because they were measured no better.
_SAME_COST = 0.02
# A step must lower the error by this part to be worth its cost.
_SAME_ERROR = 0.1
# The part of a surface's tolerance that Max Bounces may leave out.
_PART_OF_BOUNCES = 0.25


@dataclass(frozen=True)
class Shown:
    """A surface, its settings, and its share of the picture, 0 to 1.

    fixed -- why it stays as it is, "" if it may change
    """

    surface: Surface
    now: Choice
    share: float
    fixed: str = ""


@dataclass(frozen=True)
class Option:
    """A choice for a surface, with its prediction.

    error -- image L2 of its own light
    cost  -- of a pixel's sample; metal of alpha 0.25 in Single costs 1
    loss  -- the part of its light that is left out, as energy
    """

    choice: Choice
    error: float
    cost: float
    loss: float


@dataclass(frozen=True)
class Proposal:
    """The proposal for a surface, with its reason.

    now, then             -- the present and the proposed choice
    error_now, error_then -- predicted, as in Option; so are the costs and losses
    steps                 -- the prediction for every Quality, with as many bounces as it takes
    """

    now: Choice
    then: Choice
    share: float
    error_now: float
    error_then: float
    cost_now: float
    cost_then: float
    loss_now: float
    loss_then: float
    reason: str
    steps: tuple[Option, ...]

    @property
    def changes(self) -> bool:
        """Whether anything is proposed."""
        return self.now != self.then


def propose(shown: Sequence[Shown], tolerance: float) -> list[Proposal]:
    """Return a proposal for each surface. Together they cost least and are within the tolerance.

    If that is impossible, all take their closest step that is worth its cost. Exact is never
    proposed. Max Bounces is lowered only in Walk, where fewer bounces save time.
    """
    ladders = [_ladder(one, len(shown), tolerance) for one in shown]
    everything = [_options(*row) for row in zip(shown, ladders, strict=True)]
    worth = [_worth(options) for options in everything]
    chosen = [options[0] for options in worth]
    squared = sum(one.share * option.error**2 for one, option in zip(shown, chosen, strict=True))
    upgrades = [(gain, i, to) for i, row in enumerate(worth) for gain, to in _upgrades(row)]
    for _gain, i, to in sorted(upgrades, key=lambda upgrade: -upgrade[0]):
        if squared <= tolerance**2:
            break
        squared -= shown[i].share * (chosen[i].error ** 2 - to.error**2)
        chosen[i] = to
    return [_proposal(*row) for row in zip(shown, ladders, everything, chosen, strict=True)]


def total_error(proposals: Sequence[Proposal]) -> tuple[float, float]:
    """Return the predicted error of the picture now and with all proposals."""
    now = picture_error((one.share, one.error_now) for one in proposals)
    return now, picture_error((one.share, one.error_then) for one in proposals)


def time_of(shares_and_costs: Sequence[tuple[float, float]], empty: float) -> float:
    """Return the time of a sample of the picture, in units of the costs.

    empty -- the part of the picture that shows only the world. Everything else besides the
             surfaces costs 1
    """
    rest = max(1.0 - empty - sum(share for share, _ in shares_and_costs), 0.0)
    return rest + empty * background() + sum(share * cost for share, cost in shares_and_costs)


def time_ratio(proposals: Sequence[Proposal], empty: float = 0.0) -> float:
    """Return the time of a sample with all proposals over that now; `empty` as in time_of()."""
    now = time_of([(one.share, one.cost_now) for one in proposals], empty)
    then = time_of([(one.share, one.cost_then) for one in proposals], empty)
    return then / now if now > 0.0 else 1.0


def _ladder(one: Shown, count: int, tolerance: float) -> tuple[Option, ...]:
    """Return the prediction for every Quality."""
    surface, now = one.surface, one.now
    room = _PART_OF_BOUNCES * equal_part(one.share, count, tolerance)
    fewest = fewest_bounces(surface, room)
    choices = [Choice(step, _bounces(surface, step, now, fewest)) for step in QUALITIES]
    return tuple(_option(surface, choice) for choice in choices)


def _options(one: Shown, ladder: Sequence[Option]) -> list[Option]:
    """Return the possible choices; only the present one if it must stay."""
    if one.fixed:
        return [_option(one.surface, one.now)]
    steps = [step for step in STEPS if step != "Fitted" or one.surface.fitted]
    if one.now.quality == "Fitted" and not one.surface.fitted:
        steps[-1] = "Fitted"  # Fitted takes Walk by itself there
    return [option for option in ladder if option.choice.quality in steps]


def _option(surface: Surface, choice: Choice) -> Option:
    return Option(
        choice,
        predicted_error(surface, choice),
        predicted_cost(surface, choice),
        predicted_loss(surface, choice),
    )


def _bounces(surface: Surface, step: str, now: Choice, fewest: int) -> int:
    if step == "Single":
        return now.max_bounces
    return fewest if step == "Walk" or not surface.fitted else max(fewest, now.max_bounces)


def _worth(options: Sequence[Option]) -> list[Option]:
    """Return the options that are closer than all cheaper ones, by rising cost."""
    kept: list[Option] = []
    for option in sorted(options, key=lambda option: option.cost):
        if kept and option.error > (1.0 - _SAME_ERROR) * kept[-1].error:
            continue
        if kept and option.cost <= (1.0 + _SAME_COST) * kept[-1].cost:
            kept.pop()
        kept.append(option)
    return kept


def _upgrades(options: Sequence[Option]) -> list[tuple[float, Option]]:
    """Return the changes from the cheapest option to the closest, by falling gain.

    The gain is the fall of the squared error per unit of cost. An option that gains less than a
    later one is passed over.
    """
    found, at = [], 0
    while at < len(options) - 1:
        start = options[at]
        gains = {
            i: (start.error**2 - options[i].error ** 2) / (options[i].cost - start.cost)
            for i in range(at + 1, len(options))
        }
        at = max(gains, key=gains.get)
        found.append((gains[at], options[at]))
    return found


def _proposal(
    one: Shown, ladder: tuple[Option, ...], options: Sequence[Option], then: Option
) -> Proposal:
    now = _option(one.surface, one.now)
    return Proposal(
        one.now,
        then.choice,
        one.share,
        now.error,
        then.error,
        now.cost,
        then.cost,
        now.loss,
        then.loss,
        f"{one.fixed}: it stays" if one.fixed else _reason(one.surface, options, then),
        ladder,
    )


def _reason(surface: Surface, options: Sequence[Option], then: Option) -> str:
    low, high = surface.alphas
    alpha = f"alpha {high:.2g}" if high - low < 0.005 else f"alpha {low:.2g} to {high:.2g}"
    if then.choice.quality == "Single":
        return f"{alpha}: further bounces carry {percent(then.loss)} of its light"
    cheaper = [_shortfall(option) for option in options if option.cost < then.cost]
    nearest = all(option.error >= then.error for option in options)
    least = "no step costs less or is nearer" if nearest else "no step costs less"
    return f"{alpha}: {', '.join(cheaper) or least}"


def _shortfall(option: Option) -> str:
    text = f"{option.choice.quality} would be {percent(option.error)} off"
    if option.choice.quality != "Single":
        return text
    return f"{text} and lose {percent(option.loss)} of its light"
