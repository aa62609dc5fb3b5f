# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns reflectance spectra into linear Rec. 709, in daylight D65, by the CIE 1931 observer."""

import numpy as np

# Daylight D65 of CIE 15, relative power, 380 to 780 nm in steps of 10 nm.
_D65 = (
    *(49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861),
    *(115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342),
    *(95.788, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778),
    *(78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054),
    63.3828,
)

# The Gaussian lobes of x, y and z: amplitude, centre, and the widths below and above it, in nm.
# Wyman, Sloan, Shirley 2013, "Simple analytic approximations to the CIE XYZ color matching
# functions", table 1 (multi-lobe).
_LOBES = (
    ((1.056, 599.8, 37.9, 31.0), (0.362, 442.0, 16.0, 26.7), (-0.065, 501.1, 20.4, 26.2)),
    ((0.821, 568.8, 46.9, 40.5), (0.286, 530.9, 16.3, 31.1)),
    ((1.217, 437.0, 11.8, 36.0), (0.681, 459.0, 26.0, 13.8)),
)

# From XYZ to linear Rec. 709 (ITU-R BT.709's primaries, white D65).
_REC709 = np.array(
    (
        (3.2404542, -1.5371385, -0.4985314),
        (-0.9692660, 1.8760108, 0.0415560),
        (0.0556434, -0.2040259, 1.0572252),
    )
)

WAVELENGTHS = np.arange(380.0, 781.0, 5.0)  # nm

# Dominant wavelengths of the primaries of Rec. 709, nm.
CHANNELS = (611.4, 549.1, 464.2)


def matching_functions(wavelengths: np.ndarray) -> np.ndarray:
    """Return x, y and z, shape (3, n), of the observer at `wavelengths` (n) in nm."""

    def lobe(amplitude: float, centre: float, below: float, above: float) -> np.ndarray:
        width = np.where(wavelengths < centre, below, above)
        return amplitude * np.exp(-0.5 * ((wavelengths - centre) / width) ** 2)

    return np.array([sum(lobe(*values) for values in lobes) for lobes in _LOBES])


def daylight(wavelengths: np.ndarray) -> np.ndarray:
    """Return the relative power of D65 at `wavelengths` in nm, interpolated linearly (CIE 15)."""
    return np.interp(wavelengths, np.arange(380.0, 781.0, 10.0), _D65)


def colour(reflectances: np.ndarray) -> np.ndarray:
    """Return the linear Rec. 709 colour, shape (3), of reflectances at WAVELENGTHS.

    White is exactly 1, 1, 1: a scale corrects the small error of the analytic functions.
    Colours outside Rec. 709 have channels below 0 or above 1.
    """
    weights = _REC709 @ (matching_functions(WAVELENGTHS) * daylight(WAVELENGTHS))
    return weights @ reflectances / weights.sum(axis=1)
