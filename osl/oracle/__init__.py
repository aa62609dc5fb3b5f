# SPDX-License-Identifier: GPL-3.0-or-later
"""Independent double-precision model of light that bounces inside a rough surface.

Written from the equations of the supplement of Wang et al., "Position-free Multiple-bounce
Computations for Smith Microfacet BSDFs" (SIGGRAPH 2022), with numpy and scipy. It shares no code
with the shaders or the extension, so that it can judge both. Equation numbers are the supplement's.

Frame: ``z`` is the macro-normal (omega_g), ``wi`` points from the surface to the viewer, ``wo`` to
the light. A vertex receives the path from ``v`` (minus the direction of travel) and sends it to
``o``; ``m`` is a micronormal with ``m.z > 0``. All directions are unit vectors, shape ``(..., 3)``.
"""

from .estimate import Bounces, Energies, energies, evaluate, lobe
from .fresnel import F82Tint, IndexOfRefraction, White
from .height_field import HeightField
from .materials import Conductor, Dielectric, Diffuse
from .ray_tracer import Tracer
from .simulation import simulate, simulated_energies
from .surface import BECKMANN, CORRELATED, GGX, HEIGHT_TRACKED, UNCORRELATED, Surface
from .walk import first_bounce

__all__ = [
    "BECKMANN",
    "CORRELATED",
    "GGX",
    "HEIGHT_TRACKED",
    "UNCORRELATED",
    "Bounces",
    "Conductor",
    "Dielectric",
    "Diffuse",
    "Energies",
    "F82Tint",
    "HeightField",
    "IndexOfRefraction",
    "Surface",
    "Tracer",
    "White",
    "energies",
    "evaluate",
    "first_bounce",
    "lobe",
    "simulate",
    "simulated_energies",
]
