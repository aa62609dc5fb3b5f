# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits the error of rendered pictures into bias, which stays, and noise, which samples reduce.

With K pictures A_k of a variant (one seed each) and two pictures R_1, R_2 of the reference, all of
them independent, the mean over pixels, channels and k != l of

    (A_k - R_1) (A_l - R_2)

is an unbiased estimate of bias^2. The mean of a product of independent differences is the product
of their means, so the noise of the pictures and of the reference cancels. (Such a mean over pairs
is a U-statistic: W. Hoeffding, "A Class of Statistics with Asymptotically Normal Distribution",
1948.) It may be negative if there is almost no bias.

The standard error comes from the same pictures turned by 45 degrees. For two differences D_1, D_2
of one distribution, D_1 D_2 and (D_1^2 - D_2^2) / 2 have the same variance if the noise is
Gaussian, and the latter has more if the tails are heavier. But the latter has mean 0. Its means
over blocks of pixels show their spread, even if neighbouring pixels are correlated.
"""

import math
from dataclasses import dataclass
from itertools import combinations

# A bias counts from this many standard errors on. Noise has heavy tails, and there are many
# variants.
_STANDS_OUT = 3.0
# For the standard errors: blocks along a picture's longer side, and the fewest pixels along a
# block's side, because a pixel filter makes neighbours alike.
_BLOCKS = 12
_FEWEST = 4


@dataclass(frozen=True)
class ErrorSplit:
    """Errors relative to the root mean square of the reference.

    bias_square    -- estimate of bias^2, which may be negative
    bias_square_se -- its standard error
    noise          -- standard deviation of one picture, root mean square over the pixels
    """

    bias_square: float
    bias_square_se: float
    noise: float

    @property
    def bias(self) -> float:
        """The bias; 0 if the estimate of its square is negative."""
        return math.sqrt(max(self.bias_square, 0.0))

    @property
    def bias_se(self) -> float:
        """The standard error of the bias: half the distance between one error up and down."""
        up = math.sqrt(max(self.bias_square + self.bias_square_se, 0.0))
        down = math.sqrt(max(self.bias_square - self.bias_square_se, 0.0))
        return 0.5 * (up - down)

    @property
    def resolution(self) -> float:
        """The smallest bias that can be told from none."""
        return math.sqrt(_STANDS_OUT * self.bias_square_se)

    @property
    def resolved(self) -> bool:
        """Whether the bias stands out from its standard error."""
        return self.bias_square > _STANDS_OUT * self.bias_square_se

    def doubtful(self, error: float) -> bool:
        """Whether the bias may lie on the other side of `error`."""
        return abs(self.bias_square - error**2) < _STANDS_OUT * self.bias_square_se


def split_error(pictures: "list[numpy.ndarray]", references: "list[numpy.ndarray]") -> ErrorSplit:
    """Return the error of a variant from two pictures or more.

    All pictures are linear radiance of one shape (height, width, channels), `references` are two.
    Raises ValueError for other numbers or shapes, for values that are not finite, and for a black
    reference.
    """
    import numpy as np

    if len(pictures) < 2 or len(references) != 2:
        raise ValueError(
            f"There are {len(pictures)} pictures and {len(references)} of the reference: "
            "2 or more and 2 are needed"
        )
    first, second = (_finite(picture, references[0].shape) for picture in references)
    taken = [_finite(picture, first.shape) for picture in pictures]
    reference = 0.5 * (first + second)
    # Unbiased, unlike the square of the mean, which holds its noise too.
    level = float(np.mean(first * second))
    if not level > 0.0:
        raise ValueError("The reference is black: check camera and lights of the scene")
    count = len(taken)
    mean = sum(taken) / count
    ordered_pairs = count * (count - 1)
    to_first, to_second = count * (mean - first), count * (mean - second)
    same = sum(np.mean((p - first) * (p - second)) for p in taken)
    bias_square = float(np.mean(to_first * to_second) - same) / ordered_pairs
    noise_square = float(sum(np.mean((p - mean) ** 2) for p in taken)) / (count - 1)
    own = np.mean(
        [
            _square_se(0.5 * ((p - reference) ** 2 - (q - reference) ** 2))
            for p, q in combinations(taken, 2)
        ]
    )
    shared = _square_se((mean - reference) * (first - second))
    spread = math.sqrt(2.0 / count * float(own) + shared)
    return ErrorSplit(bias_square / level, spread / level, math.sqrt(noise_square / level))


def reference_noise(references: "list[numpy.ndarray]") -> float:
    """Return the relative noise of the mean of two pictures of the reference."""
    import numpy as np

    first, second = (np.asarray(picture, np.float64) for picture in references)
    return float(np.sqrt(np.mean((0.5 * (first - second)) ** 2) / np.mean(first * second)))


def samples_to_error(split: ErrorSplit, samples: int, error: float) -> float:
    """Return the samples that reach a relative error, infinite if the bias is above it.

    The noise falls with the root of the number of samples; `samples` are those of the pictures.
    """
    room = error**2 - max(split.bias_square, 0.0)
    return samples * split.noise**2 / room if room > 0.0 else math.inf


def error_after(split: ErrorSplit, factor: float) -> float:
    """Return the error of `factor` times the samples: bias and noise together."""
    return math.sqrt(max(split.bias_square, 0.0) + split.noise**2 / factor)


def _finite(picture: "numpy.ndarray", shape: tuple[int, ...]) -> "numpy.ndarray":
    import numpy as np

    picture = np.asarray(picture, np.float64)
    if picture.shape != shape:
        raise ValueError(f"A picture is {picture.shape}, the reference {shape}: render them anew")
    if not np.isfinite(picture).all():
        raise ValueError("A picture has pixels that are not numbers: check the scene's materials")
    return picture


def _square_se(values: "numpy.ndarray") -> float:
    """Return the squared standard error of the mean of values whose expectation is 0."""
    import numpy as np

    height, width = values.shape[:2]
    side = max(_FEWEST, round(max(height, width) / _BLOCKS))
    rows, columns = range(0, height, side), range(0, width, side)
    sums = np.add.reduceat(np.add.reduceat(values.sum(axis=2), rows, axis=0), columns, axis=1)
    return float((sums**2).sum()) / values.size**2
