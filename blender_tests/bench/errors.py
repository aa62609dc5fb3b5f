# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of pictures against a reference, all relative to the reference's mean square.

A reference is a dictionary with ``first`` and ``second``, two pictures (rows, columns, 3) of
independent noise, ``mask`` (rows, columns), and by its name the picture of a variant that has one
of its own. The oracle's pictures have little noise: there first and second are one and the same.
"""

import numpy as np

Reference = dict[str, np.ndarray]


def squared_error(picture: np.ndarray, reference: Reference, variant: str = "") -> float:
    """Squared error of a picture, noise and bias together; nan where there is no reference.

    The difference from one picture of the reference is multiplied with that from the other: their
    own noise cancels in the mean.
    """
    return squared_bias(picture, picture, reference, variant)[0]


def squared_bias(
    a: np.ndarray, b: np.ndarray, reference: Reference, variant: str = ""
) -> tuple[float, float]:
    """Squared error of what two independent pictures of a variant converge to, which may come out
    negative, and its standard error; nan where there is no reference."""
    if "first" not in reference:
        return float("nan"), float("nan")
    first, second = _pair(reference, variant)
    mask = reference["mask"]
    product = ((a - first) * (b - second))[mask].mean(axis=-1)
    power = np.mean((first * second)[mask])
    return float(product.mean() / power), float(product.std(ddof=1) / product.size**0.5 / power)


def resolution(reference: Reference, error: np.ndarray | None = None) -> float:
    """The squared error that the reference's own noise makes: below it nothing is told.

    error -- standard error of the oracle's picture, like its pixels; None where two renders are the
             reference, whose noise is of the size of their difference
    """
    first, second = _pair(reference, "")
    mask = reference["mask"]
    power = np.mean((first * second)[mask])
    if error is not None:
        return float(np.mean(error[mask] ** 2) / power)
    product = (0.5 * (first - second) ** 2)[mask].mean(axis=-1)
    return float(np.sqrt(np.mean(product**2) / product.size) / power)


def _pair(reference: Reference, variant: str) -> tuple[np.ndarray, np.ndarray]:
    if variant in reference:
        return reference[variant], reference[variant]
    return reference["first"], reference["second"]
