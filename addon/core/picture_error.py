# SPDX-License-Identifier: GPL-3.0-or-later
"""How the errors of surfaces make up that of a picture, and how it is shared out among them."""

from collections.abc import Sequence

DEFAULT_TOLERANCE = 0.01


def limit_of(share: float, count: int, tolerance: float) -> float:
    """Return how far off one of `count` surfaces may be that fills `share` of the picture.

    The squared errors of a picture add up by the shares of its surfaces, so each may spend an equal
    part of the squared tolerance: share * limit^2 = tolerance^2 / count. That holds the picture
    below the tolerance whatever the others do, is looser for what is small, and needs no search.
    """
    return tolerance / (share * count) ** 0.5


def picture_error(shares_and_errors: Sequence[tuple[float, float]]) -> float:
    """Return the error of a picture whose surfaces are as bright as one another."""
    return sum(share * error**2 for share, error in shares_and_errors) ** 0.5


def percent(number: float) -> str:
    """Return an error as text with two digits."""
    if 0.0 < number < 5e-5:
        return "under 0.01 %"
    return f"{100.0 * number:.2g} %" if number < 0.995 else f"{100.0 * number:.0f} %"
