# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of Fig. 2: masking on the full sphere, by formula and by integration."""

from dataclasses import dataclass

import numpy as np

from osl.oracle.masking import G1
from osl.oracle.quadrature import projected_area
from osl.oracle.surface import Surface
from osl.oracle.vectors import direction


@dataclass(frozen=True)
class MaskingCurve:
    """Task: G1dist at ``angles`` angles over 0..pi, none of them pi/2, at the azimuth of x."""

    surface: Surface
    angles: int

    @property
    def cost(self) -> int:
        """In walks of about the same time, for the progress bar."""
        return 5_000 * self.angles

    def run(self, seed: int) -> dict[str, np.ndarray]:
        """``theta``, ``formula`` (eq. 3) and ``integral`` (eq. 4), all ``(angles,)``; infinite
        if no micronormal is visible in double precision."""
        theta = np.pi * (np.arange(self.angles) + 0.5) / self.angles
        w = direction(theta)
        area = np.array([projected_area(one, self.surface) for one in w])
        with np.errstate(divide="ignore", over="ignore"):
            integral = np.abs(w[:, 2]) / area
            return {"theta": theta, "formula": G1(w, self.surface), "integral": integral}
