# SPDX-License-Identifier: GPL-3.0-or-later
"""The lobes of simulated surfaces, from rays traced on random height fields."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from osl.oracle.height_field import HeightField
from osl.oracle.materials import Material
from osl.oracle.simulation import Hit, Tracer, simulate
from osl.oracle.surface import BECKMANN, Surface

from .lobes import MAX_BOUNCES, Sums, gather, incident

RESOLUTION = 8.0  # samples in a correlation length


@dataclass(frozen=True)
class Traced:
    """Task: rays on ``sheets``, the seeds of an even number of random sheets.

    ``alpha`` is (alpha_x, alpha_y); ``cells`` and ``resolution`` as in `HeightField.gaussian`. Each
    sheet takes ``rays`` rays for each of ``materials`` and ``thetas``. Alpha only scales a sheet,
    so all cases share the sheets' errors. The slopes of a ``stretched`` sheet have exactly the
    variances of alpha. Otherwise only the mean over all sheets has. Stretching takes the scatter of
    the slopes out of the results; the README says how much it is.
    """

    alpha: tuple[float, float]
    materials: tuple[Material, ...]
    thetas: tuple[float, ...]
    sheets: tuple[int, ...]
    rays: int
    cells: int
    resolution: float = RESOLUTION
    stretched: bool = True

    @property
    def cost(self) -> int:
        """Number of rays, for the progress bar."""
        return self.rays * len(self.sheets) * len(self.materials) * len(self.thetas)

    def sheet(self, number: int) -> HeightField:
        """The random sheet of seed ``number``."""
        surface = Surface(*self.alpha, BECKMANN)
        field = HeightField.gaussian(surface, self.cells, self.resolution, number)
        if not self.stretched:
            return field
        variance = field.slope_statistics().variance
        stretch = np.sqrt(2.0 * variance) / self.alpha
        return replace(field, spacing=tuple(stretch * field.spacing))

    def run(self, seed: int) -> Sums:
        """The exits; each sheet is a part. All arrays begin with the axes material and theta."""
        rng = np.random.default_rng(seed)
        tracers = [Tracer(self.sheet(number)) for number in self.sheets]

        def parts(material: Material, theta: float) -> Iterator[Iterator[Hit]]:
            for tracer in tracers:
                yield simulate(tracer, incident(theta), material, MAX_BOUNCES, self.rays, rng)

        found = [
            gather(parts(material, theta), self.rays)
            for material in self.materials
            for theta in self.thetas
        ]
        grid = (len(self.materials), len(self.thetas))
        return {
            name: np.stack([one[name] for one in found]).reshape(*grid, *found[0][name].shape)
            for name in found[0]
        }
