# SPDX-License-Identifier: GPL-3.0-or-later
"""What a rough surface is: widths of its NDF, the NDF's name, and its Fresnel factor."""

from dataclasses import dataclass, field

import numpy as np

from .fresnel import Fresnel, White

GGX = "GGX"
BECKMANN = "BECKMANN"


@dataclass(frozen=True)
class Surface:
    """A rough conductor.

    ``alpha_x``, ``alpha_y``: widths of the NDF along x and y, finite and > 0.
    ``distribution``: ``GGX`` or ``BECKMANN``. ``fresnel``: reflectance as a function of the cosine.
    Raises ``ValueError`` for any other value.
    """

    alpha_x: float
    alpha_y: float
    distribution: str = GGX
    fresnel: Fresnel = field(default_factory=White)

    def __post_init__(self) -> None:
        for name in ("alpha_x", "alpha_y"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} is {value}; give a finite width greater than 0")
        if self.distribution not in (GGX, BECKMANN):
            raise ValueError(f"distribution is {self.distribution!r}; give {GGX!r} or {BECKMANN!r}")

    @classmethod
    def from_roughness(
        cls,
        roughness: float,
        anisotropy: float = 0.0,
        distribution: str = GGX,
        fresnel: Fresnel | None = None,
    ) -> "Surface":
        """The surface of Cycles' Metallic BSDF: ``alpha = roughness^2``, spread by the aspect
        ``sqrt(1 - 0.9 anisotropy)`` and limited to 1. Both arguments lie in 0..1, roughness above
        0."""
        for name, value in (("roughness", roughness), ("anisotropy", anisotropy)):
            if not 0.0 <= value <= 1.0:
                raise ValueError(f"{name} is {value}; give a number from 0 to 1")
        aspect = np.sqrt(1.0 - 0.9 * anisotropy)
        alpha = roughness * roughness
        alpha_x, alpha_y = float(min(alpha / aspect, 1.0)), float(alpha * aspect)
        return cls(alpha_x, alpha_y, distribution, fresnel or White())
