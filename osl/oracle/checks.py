# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of numbers that callers give. Every message names the value and what would do."""

from numbers import Integral, Real

import numpy as np

# Squares of widths and of indices of refraction, and their ratios, stay far from the limits of
# double precision in this range; beyond it a surface is a mirror, or light goes straight on.
SMALLEST, LARGEST = 1e-8, 1e8


def count(value: object, name: str, least: int) -> int:
    """``value`` as an int, at least ``least``; ``TypeError`` or ``ValueError`` otherwise."""
    if not isinstance(value, Integral) or isinstance(value, bool):
        raise TypeError(f"{name} is {value!r}; give a whole number")
    if value < least:
        raise ValueError(f"{name} is {value}; give {least} or more")
    return int(value)


def number(value: object, name: str, low: float, high: float, what: str) -> float:
    """``value`` as a float from ``low`` to ``high``; else ``TypeError``, or ``ValueError`` that
    calls it a ``what``."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise TypeError(f"{name} is {value!r}; give a number")
    if not low <= value <= high:  # as for NaN, which compares false
        raise ValueError(f"{name} is {value}; give a {what} from {low:g} to {high:g}")
    return float(value)


def generator(rng: object) -> np.random.Generator:
    """A Generator from one, or from a seed >= 0; ``ValueError`` otherwise."""
    try:
        return np.random.default_rng(rng)
    except (TypeError, ValueError) as error:
        raise ValueError(f"rng is {rng!r}; give a Generator, or a seed of 0 or more") from error
