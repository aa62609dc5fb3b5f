# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP: how different two pictures look to someone who flips between them.

P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A
Difference Evaluator for Alternating Images", Proceedings of the ACM in Computer Graphics and
Interactive Techniques 3(2), 2020. Written from the paper, whose section numbers stand below; for
pictures of low dynamic range, display-referred sRGB from 0 to 1.
"""

import math

# 0.7 m away from a screen of 3840 pixels on 0.7 m, as the paper has it.
PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * math.pi / 180.0

# Section 4.1.1, table 1: the contrast sensitivity of achromatic, red-green and blue-yellow as sums
# of Gaussians, each by its a and b.
_SENSITIVITY = (
    ((1.0, 0.0047),),
    ((1.0, 0.0053),),
    ((34.1, 0.04), (13.5, 0.025)),
)
_COLOR_EXPONENT = 0.7  # q_c, section 4.1.3
_KNEE_FROM, _KNEE_TO = 0.4, 0.95  # p_c and p_t
_FEATURE_WIDTH = 0.082  # w in degrees, section 4.2
_FEATURE_EXPONENT = 0.5  # q_f

_TO_XYZ = (
    (10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794),
    (2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897),
    (1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382),
)


def flip(reference: "numpy.ndarray", test: "numpy.ndarray") -> "numpy.ndarray":
    """Return the FLIP error of each pixel, 0 to 1, as (height, width).

    Both pictures are sRGB from 0 to 1, (height, width, 3); what lies outside is clamped. Raises
    ValueError for other or different shapes and for what is not finite.
    """
    import numpy as np

    first, second = (np.asarray(picture, np.float64) for picture in (reference, test))
    if first.shape != second.shape or first.ndim != 3 or first.shape[2] != 3:
        raise ValueError(f"The pictures are {first.shape} and {second.shape}: give two of one size")
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise ValueError("A picture has pixels that are not numbers: check the scene's materials")
    first, second = (_opponent(np.clip(picture, 0.0, 1.0)) for picture in (first, second))
    color = _color_difference(_seen(first), _seen(second))
    feature = _feature_difference(first[..., 0], second[..., 0])
    return color ** (1.0 - feature)


def _opponent(srgb: "numpy.ndarray") -> "numpy.ndarray":
    """Return sRGB in the opponent space YCxCz (section 4.1)."""
    import numpy as np

    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    x, y, z = np.moveaxis(linear @ np.array(_TO_XYZ).T / _white(), -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def _white() -> "numpy.ndarray":
    import numpy as np

    return np.array(_TO_XYZ).sum(axis=1)


def _seen(opponent: "numpy.ndarray") -> "numpy.ndarray":
    """Blur as the eye does, and return Hunt-adjusted L*a*b* (sections 4.1.1 and 4.1.2)."""
    import numpy as np

    blurred = np.stack(
        [_sensed(opponent[..., c], terms) for c, terms in enumerate(_SENSITIVITY)], axis=-1
    )
    y = (blurred[..., 0] + 16.0) / 116.0
    x, z = y + blurred[..., 1] / 500.0, y - blurred[..., 2] / 200.0
    xyz = np.stack([x, y, z], axis=-1) * _white()
    linear = np.clip(xyz @ np.linalg.inv(np.array(_TO_XYZ)).T, 0.0, 1.0)
    return _hunt_lab(linear)


def _hunt_lab(linear: "numpy.ndarray") -> "numpy.ndarray":
    import numpy as np

    ratio = linear @ np.array(_TO_XYZ).T / _white()
    limit = 6.0 / 29.0
    x, y, z = np.moveaxis(
        np.where(ratio > limit**3, np.cbrt(ratio), ratio / (3.0 * limit**2) + 4.0 / 29.0), -1, 0
    )
    lightness = 116.0 * y - 16.0
    hunt = 0.01 * lightness
    return np.stack([lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)], axis=-1)


def _sensed(channel: "numpy.ndarray", terms: tuple[tuple[float, float], ...]) -> "numpy.ndarray":
    """Filter with the kernel of table 1, made to sum to 1."""
    import numpy as np

    widest = max(b for terms_ in _SENSITIVITY for _, b in terms_)
    radius = math.ceil(3.0 * math.sqrt(widest / (2.0 * math.pi**2)) * PIXELS_PER_DEGREE)
    degrees = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
    result, total = 0.0, 0.0
    for a, b in terms:
        line = np.exp(-(math.pi**2) * degrees**2 / b)
        factor = a * math.sqrt(math.pi / b)
        result = result + factor * _filtered(channel, line, line)
        total += factor * line.sum() ** 2
    return result / total


def _color_difference(first: "numpy.ndarray", second: "numpy.ndarray") -> "numpy.ndarray":
    """Return the HyAB distance, pressed into 0 to 1 (section 4.1.3)."""
    import numpy as np

    def distance(one: "numpy.ndarray", other: "numpy.ndarray") -> "numpy.ndarray":
        apart = one - other
        return np.abs(apart[..., 0]) + np.hypot(apart[..., 1], apart[..., 2])

    green, blue = (_hunt_lab(np.array(color)) for color in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    most = distance(green, blue) ** _COLOR_EXPONENT
    apart = distance(first, second) ** _COLOR_EXPONENT
    knee = _KNEE_FROM * most
    low = apart * _KNEE_TO / knee
    high = _KNEE_TO + (apart - knee) / (most - knee) * (1.0 - _KNEE_TO)
    return np.where(apart < knee, low, high)


def _feature_difference(first: "numpy.ndarray", second: "numpy.ndarray") -> "numpy.ndarray":
    """Return how different edges and points are, 0 to 1 (section 4.2)."""
    import numpy as np

    spread = 0.5 * _FEATURE_WIDTH * PIXELS_PER_DEGREE
    radius = math.ceil(3.0 * spread)
    x = np.arange(-radius, radius + 1.0)
    smooth = np.exp(-(x**2) / (2.0 * spread**2))
    detectors = (-x * smooth, (x**2 / spread**2 - 1.0) * smooth)  # of edges, of points
    differences = []
    for detector in detectors:
        strengths = []
        for channel in (first, second):
            light = (channel + 16.0) / 116.0
            along = _signed_unit(detector, smooth)
            across = _filtered(light, smooth, along), _filtered(light, along, smooth)
            strengths.append(np.hypot(*across))
        differences.append(np.abs(strengths[0] - strengths[1]))
    stronger = np.maximum(*differences)
    return np.clip((stronger / math.sqrt(2.0)) ** _FEATURE_EXPONENT, 0.0, 1.0)


def _signed_unit(detector: "numpy.ndarray", smooth: "numpy.ndarray") -> "numpy.ndarray":
    """Scale a detector so that with `smooth` across its parts above and below 0 sum to 1 and -1."""
    import numpy as np

    positive = detector[detector > 0].sum() * smooth.sum()
    negative = -detector[detector < 0].sum() * smooth.sum()
    return np.where(detector > 0, detector / positive, detector / negative)


def _filtered(
    channel: "numpy.ndarray", column: "numpy.ndarray", row: "numpy.ndarray"
) -> "numpy.ndarray":
    """Correlate with the product of two lines of one length, the border's pixels repeated."""
    import numpy as np

    height, width = channel.shape
    radius = len(column) // 2
    padded = np.pad(channel, radius, mode="edge")
    vertical = sum(weight * padded[i : i + height] for i, weight in enumerate(column))
    return sum(weight * vertical[:, i : i + width] for i, weight in enumerate(row))
