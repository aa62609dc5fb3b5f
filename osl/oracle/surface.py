# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough surface: the alphas and the name of its NDF, its material, and the model of its walk."""

from dataclasses import dataclass, field

import numpy as np

from .checks import LARGEST, SMALLEST, number
from .fresnel import Fresnel, White
from .materials import Conductor, Material

GGX = "GGX"
BECKMANN = "BECKMANN"

CORRELATED = "CORRELATED"  # height-correlated masking and shadowing (eqs. 12, 14-17)
UNCORRELATED = "UNCORRELATED"  # separable masking and shadowing (eqs. 3, 19-24); reciprocal
HEIGHT_TRACKED = "HEIGHT_TRACKED"  # the walk carries its height (Heitz et al. 2016)
MODELS = (CORRELATED, UNCORRELATED, HEIGHT_TRACKED)


@dataclass(frozen=True)
class Surface:
    """A rough surface.

    ``alpha_x``, ``alpha_y``: widths of the NDF along x and y, 1e-8 to 1e8. ``distribution``:
    ``GGX`` or ``BECKMANN``. ``material``: what its facets are made of, by default a lossless
    conductor. ``model``: ``CORRELATED``, ``UNCORRELATED`` or ``HEIGHT_TRACKED``.
    Raises ``ValueError`` for any other value and ``TypeError`` for widths that are not numbers.
    """

    alpha_x: float
    alpha_y: float
    distribution: str = GGX
    material: Material = field(default_factory=Conductor)
    model: str = CORRELATED

    def __post_init__(self) -> None:
        for name in ("alpha_x", "alpha_y"):
            number(getattr(self, name), name, SMALLEST, LARGEST, "width")
        if self.distribution not in (GGX, BECKMANN):
            raise ValueError(f"distribution is {self.distribution!r}; give {GGX!r} or {BECKMANN!r}")
        if not isinstance(self.material, Material):
            raise ValueError(
                f"material is {self.material!r}; give a Conductor, a Dielectric or a Diffuse"
            )
        if self.model not in MODELS:
            raise ValueError(f"model is {self.model!r}; give one of {', '.join(MODELS)}")

    @classmethod
    def from_roughness(
        cls,
        roughness: float,
        anisotropy: float = 0.0,
        distribution: str = GGX,
        fresnel: Fresnel | None = None,
    ) -> "Surface":
        """The surface of Cycles' Metallic BSDF: ``alpha = roughness^2``, spread by the aspect
        ``sqrt(1 - 0.9 anisotropy)`` and limited to 1. Roughness is 1e-4 to 1, anisotropy 0 to 1."""
        number(roughness, "roughness", np.sqrt(SMALLEST), 1.0, "number")
        number(anisotropy, "anisotropy", 0.0, 1.0, "number")
        aspect = np.sqrt(1.0 - 0.9 * anisotropy)
        alpha = roughness * roughness
        alpha_x, alpha_y = float(min(alpha / aspect, 1.0)), float(alpha * aspect)
        return cls(alpha_x, alpha_y, distribution, Conductor(fresnel or White()))
