# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of pictures against a reference, all relative to the reference's mean square.

A reference is a dictionary. ``first`` and ``second`` are two pictures (rows, columns, 3) of
independent noise, and ``mask`` is (rows, columns). A variant may have a picture of its own, under
its name. The oracle's pictures have little noise, so first and second are the same array there.
"""

import numpy as np

from addon.core.cost.statistics import ErrorSplit, split_error

Reference = dict[str, np.ndarray]


def squared_error(picture: np.ndarray, reference: Reference, variant: str = "") -> float:
    """Squared error of a picture, noise and bias together; nan if there is no reference.

    It is the mean product of the differences from the reference's two pictures. Their own noise
    cancels in that mean.
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
    """Error of a variant's converged picture; None without a reference or with under two pictures.

    pictures -- (rows, columns, 3) each, of equal samples and independent noise
    """
    if "first" not in reference or len(pictures) < 2:
        return None
    mask = reference["mask"][..., None]
    pair = [np.where(mask, one, 0.0) for one in _pair(reference, variant)]
    return split_error([np.where(mask, one, 0.0) for one in pictures], pair)


def resolution(reference: Reference, error: np.ndarray | None = None) -> float:
    """The squared error of the reference's own noise, below which no error can be measured.

    error -- standard error of the oracle's pixels (rows, columns, 3). None if the reference is two
             renders, because their difference shows their noise.
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
