# SPDX-License-Identifier: GPL-3.0-or-later
"""Says in one sentence, from the numbers, which Quality to take."""

import math
from collections.abc import Sequence

from .results import Measured

# In the place of a time.
UNTIMED = "too short"


def recommendation(variants: Sequence[Measured], error: float) -> str:
    """Return which step reaches a relative error soonest, and how the others compare.

    If none does, it names the closest one and its bias. If no Quality was measured, it compares the
    other variants. It says what the noise leaves open, and compares only real times.
    """
    steps = [v for v in variants if v.family == "step"] or list(variants)
    open_ones = [v for v in steps if v.split.doubtful(error)]
    if not all(v.is_timed for v in steps):
        best = min(steps, key=lambda v: v.split.bias)
        return (
            "The renders are too short to be timed: give more samples or a larger size. "
            f"Nearest is {best.title}, {_bias(best)}."
        )
    best = min(steps, key=lambda v: v.seconds_to(error))
    if math.isinf(best.seconds_to(error)):
        best = min(steps, key=lambda v: v.split.bias)
        parts = [f"no step comes within {_percent(error)} here", f"nearest is {best.title}"]
        parts[-1] += f", {_bias(best)}"
    else:
        parts = [f"{best.title} is within {_percent(error)} soonest here, after "]
        parts[0] += duration(best.seconds_to(error))
        parts += _comparison(best, [v for v in steps if v not in (best, *open_ones)], error)
    text = "; ".join(parts)
    if best in open_ones:
        text = f"as far as the noise shows, {text}"
    sentence = f"{text[0].upper()}{text[1:]}."
    if open_ones:
        names = ", ".join(v.title for v in open_ones)
        sentence += f" The noise leaves open {names}: give more samples or more rounds."
    return sentence


def _comparison(best: Measured, others: Sequence[Measured], error: float) -> list[str]:
    """Return how much faster the best is than the next one, and which never come there."""
    parts = []
    reached = [v for v in others if math.isfinite(v.seconds_to(error))]
    if reached:
        second = min(reached, key=lambda v: v.seconds_to(error))
        times = second.seconds_to(error) / best.seconds_to(error)
        text = f"{times:.1f}" if times < 10.0 else f"{times:.0f}"
        faster = f"{text} times faster than" if times >= 1.05 else "as fast as"
        parts.append(f"{faster} {second.title}")
    never = [v for v in others if v not in reached]
    if never:
        parts.append("never within it: " + ", ".join(f"{v.title} ({_bias(v)})" for v in never))
    return parts


def seconds(variant: Measured, error: float) -> str:
    """Return the time of a variant to an error in words, "never" if it does not get there.

    A question mark follows if the noise leaves that open.
    """
    if not variant.is_timed:
        return UNTIMED
    time = variant.seconds_to(error)
    text = duration(time) if math.isfinite(time) else "never"
    return f"{text} ?" if variant.split.doubtful(error) else text


def spent(time: float | None) -> str:
    """Return seconds in words, or that they were too short to measure."""
    return UNTIMED if time is None else duration(time)


def duration(time: float) -> str:
    """Return seconds in a unit that reads well, such as "12 s", "3.5 min" or "2.1 h"."""
    if time < 120.0:
        return f"{time:.2g} s" if time < 10.0 else f"{time:.0f} s"
    return f"{time / 60:.1f} min" if time < 7200.0 else f"{time / 3600:.1f} h"


def bias_text(variant: Measured) -> str:
    """Return the bias with its standard error, or the bound below which it is not resolved."""
    split = variant.split
    if split.resolved:
        return f"{_percent(split.bias)} ± {_percent(split.bias_se)}"
    return f"below {_percent(split.resolution)}"


def _bias(variant: Measured) -> str:
    return f"bias {bias_text(variant)}"


def _percent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 0.1 else f"{100 * part:.0f} %"
