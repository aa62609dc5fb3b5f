# SPDX-License-Identifier: GPL-3.0-or-later
"""The sentence that says, from the numbers, which step of the ladder to take."""

import math
from collections.abc import Sequence

from .results import Measured

# Cycles' own closures with OSL off are no choice for a material that needs OSL.
_CHOICES = ("step",)


def recommendation(variants: Sequence[Measured], error: float) -> str:
    """Return which step reaches a relative error soonest, and how the others compare.

    Where none does, it names the one that comes nearest and its bias; where the steps were not
    measured, it compares what was.
    """
    steps = [v for v in variants if v.family in _CHOICES] or list(variants)
    order = sorted(steps, key=lambda v: v.seconds_to(error))
    best, target = order[0], _percent(error)
    if math.isinf(best.seconds_to(error)):
        best = min(steps, key=lambda v: v.split.bias)
        text = f"No step comes within {target} here: {best.title} is nearest, {_bias(best)}"
        return f"{text}{_doubt(steps, error)}."
    parts = [f"{best.title} is within {target} soonest here, after {seconds(best, error)}"]
    if len(order) > 1 and math.isfinite(order[1].seconds_to(error)):
        times = order[1].seconds_to(error) / best.seconds_to(error)
        faster = f"{times:.1f} times faster than" if times >= 1.05 else "as fast as"
        parts.append(f"{faster} {order[1].title}")
    never = [v for v in steps if math.isinf(v.seconds_to(error))]
    if never:
        named = ", ".join(f"{v.title} ({_bias(v)})" for v in never)
        parts.append(f"never within it: {named}")
    return f"{'; '.join(parts)}{_doubt(steps, error)}."


def seconds(variant: Measured, error: float) -> str:
    """Return the time of a variant to an error in words, "never" where it does not come."""
    time = variant.seconds_to(error)
    return duration(time) if math.isfinite(time) else "never"


def duration(time: float) -> str:
    """Return seconds in a unit that reads well, such as "12 s", "3.5 min" or "2.1 h"."""
    if time < 120.0:
        return f"{time:.2g} s" if time < 10.0 else f"{time:.0f} s"
    return f"{time / 60:.1f} min" if time < 7200.0 else f"{time / 3600:.1f} h"


def bias_text(variant: Measured) -> str:
    """Return the bias with its standard error, or below what it is not resolved."""
    split = variant.split
    if split.resolved:
        return f"{_percent(split.bias)} ± {_percent(split.bias_se)}"
    return f"below {_percent(split.resolution)}"


def _bias(variant: Measured) -> str:
    return f"bias {bias_text(variant)}"


def _doubt(steps: Sequence[Measured], error: float) -> str:
    """Return a warning about the steps whose bias may as well lie on the other side of `error`."""
    open_ones = [v.title for v in steps if v.split.doubtful(error)]
    if not open_ones:
        return ""
    return f" (too much noise to tell for {', '.join(open_ones)}: give more samples or more rounds)"


def _percent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 0.1 else f"{100 * part:.0f} %"
