# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the numbers that callers give. Every message names the value and the remedy."""

from numbers import Integral, Real

import numpy as np

# In this range squares and ratios of alphas and of indices of refraction stay far from the limits
# of double precision. Beyond it a surface is a mirror, or light goes straight on.
SMALLEST, LARGEST = 1e-8, 1e8


def count(value: object, name: str, least: int) -> int:
    """``value`` as an int, at least ``least``; ``TypeError`` or ``ValueError`` otherwise."""
    if not isinstance(value, Integral) or isinstance(value, bool):
        raise TypeError(f"{name} is {value!r}; give a whole number")
    if value < least:
        raise ValueError(f"{name} is {value}; give {least} or more")
    return int(value)


def number(value: object, name: str, low: float, high: float, what: str) -> float:
    """``value`` as a float from ``low`` to ``high``; ``TypeError`` or ``ValueError`` otherwise.

    ``what``: the message's word for such a number.
    """
    if not isinstance(value, Real) or isinstance(value, bool):
        raise TypeError(f"{name} is {value!r}; give a number")
    if not low <= value <= high:  # also true for NaN
        raise ValueError(f"{name} is {value}; give a {what} from {low:g} to {high:g}")
    return float(value)


def generator(rng: object) -> np.random.Generator:
    """A Generator from a Generator or a seed >= 0; ``ValueError`` otherwise."""
    try:
        return np.random.default_rng(rng)
    except (TypeError, ValueError) as error:
        raise ValueError(f"rng is {rng!r}; give a Generator, or a seed of 0 or more") from error
