# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic of intervals (smallest, largest), for what the nodes of a material can give."""

from collections.abc import Callable, Sequence
from itertools import product
from math import inf, isnan

Interval = tuple[float, float]
ANYTHING: Interval = (-inf, inf)


def corners(function: Callable[..., float], *arguments: Interval) -> Interval:
    """Return the range of a function that is monotonic in each of its arguments.

    Where it has no value, as inf - inf or a root of less than 0, anything is possible.
    """
    values = []
    for point in product(*arguments):
        try:
            value = function(*point)
        except (ArithmeticError, ValueError):
            return ANYTHING
        if isinstance(value, complex) or isnan(value):
            return ANYTHING
        values.append(value)
    return min(values), max(values)


def times(a: float, b: float) -> float:
    """Return a product in which 0 times anything is 0, as an unknown number is finite."""
    return 0.0 if a == 0.0 or b == 0.0 else a * b


def clamped(interval: Interval, low: float = 0.0, high: float = 1.0) -> Interval:
    """Return the interval with both ends within `low` to `high`."""
    return tuple(min(max(end, low), high) for end in interval)


def hull(intervals: Sequence[Interval]) -> Interval:
    """Return the smallest interval that holds all of them (at least one)."""
    return min(low for low, _ in intervals), max(high for _, high in intervals)


def _add(a: Interval, b: Interval) -> Interval:
    return a[0] + b[0], a[1] + b[1]


def _divide(a: Interval, b: Interval) -> Interval:
    if b[0] <= 0.0 <= b[1]:
        return (0.0, 0.0) if b == (0.0, 0.0) else ANYTHING  # Blender's x / 0 is 0
    return corners(lambda x, y: times(x, 1.0 / y), a, b)


def _power(base: Interval, exponent: Interval) -> Interval:
    if base[0] < 0.0:
        return ANYTHING
    return corners(lambda x, y: x**y, base, exponent)


def _absolute(a: Interval) -> Interval:
    ends = sorted(map(abs, a))
    return (0.0 if a[0] <= 0.0 <= a[1] else ends[0]), ends[1]


def multiplied(a: Interval, b: Interval) -> Interval:
    """Return the range of a product."""
    return corners(times, a, b)


# By the names of Blender's Math node.
OPERATIONS: dict[str, Callable[..., Interval]] = {
    "ADD": lambda a, b, _: _add(a, b),
    "SUBTRACT": lambda a, b, _: (a[0] - b[1], a[1] - b[0]),
    "MULTIPLY": lambda a, b, _: multiplied(a, b),
    "DIVIDE": lambda a, b, _: _divide(a, b),
    "MULTIPLY_ADD": lambda a, b, c: _add(multiplied(a, b), c),
    "POWER": lambda a, b, _: _power(a, b),
    "SQRT": lambda a, _b, _c: tuple(max(end, 0.0) ** 0.5 for end in a),
    "ABSOLUTE": lambda a, _b, _c: _absolute(a),
    "MINIMUM": lambda a, b, _: (min(a[0], b[0]), min(a[1], b[1])),
    "MAXIMUM": lambda a, b, _: (max(a[0], b[0]), max(a[1], b[1])),
}


def mapped(value: Interval, source: Interval, target: Interval, clamp: bool) -> Interval:
    """Return where a straight line takes `value`: `source`'s ends to `target`'s (ends, not sorted).

    A source without length gives target's first end, as Blender's Map Range does.
    """
    if source[0] == source[1]:
        return target[0], target[0]
    length = source[1] - source[0]
    part = sorted((end - source[0]) / length for end in value)
    if clamp:
        part = clamped(part)
    ends = [target[0] + times(end, target[1] - target[0]) for end in part]
    return min(ends), max(ends)


def mixed(factor: Interval, a: Interval, b: Interval) -> Interval:
    """Return the range of a mix: `a` at factor 0, `b` at 1."""
    return corners(lambda f, x, y: times(1.0 - f, x) + times(f, y), factor, a, b)
