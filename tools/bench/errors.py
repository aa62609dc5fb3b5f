# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of pictures against a reference, all relative to the reference's mean square.

A reference is a dictionary with ``first`` and ``second``, two pictures (rows, columns, 3) of
independent noise, ``mask`` (rows, columns), and by its name the picture of a variant that has one
of its own. The oracle's pictures have little noise: there first and second are one and the same.
"""

import numpy as np

from addon.core.cost.statistics import ErrorSplit, split_error

Reference = dict[str, np.ndarray]


def squared_error(picture: np.ndarray, reference: Reference, variant: str = "") -> float:
    """Squared error of a picture, noise and bias together; nan if there is no reference.

    The difference from one picture of the reference is multiplied with that from the other: their
    own noise cancels in the mean.
    """
    if "first" not in reference:
        return float("nan")
    first, second = _pair(reference, variant)
    mask = reference["mask"]
    product = (picture - first) * (picture - second)
    return float(product[mask].mean() / (first * second)[mask].mean())


def converged(
    pictures: list[np.ndarray], reference: Reference, variant: str = ""
) -> ErrorSplit | None:
    """Error of what a variant converges to, from pictures of equal samples and independent noise.

    None without a reference or with fewer than two pictures.
    """
    if "first" not in reference or len(pictures) < 2:
        return None
    mask = reference["mask"][..., None]
    pair = [np.where(mask, one, 0.0) for one in _pair(reference, variant)]
    return split_error([np.where(mask, one, 0.0) for one in pictures], pair)


def resolution(reference: Reference, error: np.ndarray | None = None) -> float:
    """The squared error that the reference's own noise makes: below it nothing is told.

    error -- standard error of the oracle's picture, like its pixels; None if two renders are the
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
