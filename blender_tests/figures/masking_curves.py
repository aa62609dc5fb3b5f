# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of Fig. 2: masking on the full sphere, by formula and by integration."""

from dataclasses import dataclass

import numpy as np

from blender_tests.oracle.masking import G1
from blender_tests.oracle.ndf import D
from blender_tests.oracle.quadrature import visible_normals
from blender_tests.oracle.surface import Surface
from blender_tests.oracle.vectors import direction, dot

NODES = 80  # of the rule along each axis: enough for 12 digits


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
        where no micronormal is visible that double precision can tell from none."""
        theta = np.pi * (np.arange(self.angles) + 0.5) / self.angles
        w = direction(theta)
        area = np.array([self._projected_area(one) for one in w])
        with np.errstate(divide="ignore", over="ignore"):
            integral = np.abs(w[:, 2]) / area
            return {"theta": theta, "formula": G1(w, self.surface), "integral": integral}

    def _projected_area(self, w: np.ndarray) -> float:
        """The integral of <w,m> D(m) over the micronormals that face ``w`` ``(3,)``."""
        m, weight = visible_normals(w, self.surface, NODES)
        return (weight * np.maximum(dot(m, w), 0.0) * D(m, self.surface)).sum()
