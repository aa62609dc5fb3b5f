# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the errors of surfaces to that of a picture, and shares a tolerance out among them."""

from collections.abc import Iterable

DEFAULT_TOLERANCE = 0.01


def picture_error(shares_and_errors: Iterable[tuple[float, float]]) -> float:
    """Return the error of a picture whose surfaces are equally bright.

    Squared errors add up in proportion to the surfaces' shares of the picture.
    """
    return sum(share * error**2 for share, error in shares_and_errors) ** 0.5


def equal_part(share: float, count: int, tolerance: float) -> float:
    """Return how far off each of `count` surfaces may be, if all spend the tolerance equally."""
    return tolerance / (share * count) ** 0.5


def percent(number: float) -> str:
    """Return an error as text with two digits."""
    if 0.0 < number < 5e-5:
        return "under 0.01 %"
    return f"{100.0 * number:.2g} %" if number < 0.995 else f"{100.0 * number:.0f} %"
