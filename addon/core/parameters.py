# SPDX-License-Identifier: GPL-3.0-or-later
"""The one specification of every material parameter.

Shader parameters, node-group sockets and documentation are made from this or tested against it.
What all materials have is written once and comes last in each of them.
"""

from .parameter import Parameter

FRESNEL_PANEL = "Fresnel"
BOUNCES_PANEL = "Multiple Bounces"

_OF_ALL_KINDS: tuple[Parameter, ...] = (
    Parameter(
        "Roughness",
        "Roughness",
        "FLOAT",
        0.5,
        (0.0, 1.0),
        (0.1, 1.0),
        tooltip="Roughness of the microsurface: alpha is its square. Further bounces become "
        "visible above 0.4",
    ),
    Parameter(
        "Anisotropy",
        "Anisotropy",
        "FLOAT",
        0.0,
        (0.0, 1.0),
        (0.0, 0.95),
        tooltip="Makes the microsurface rougher along the tangent and smoother across it: the two "
        "alphas are alpha / a and alpha * a with a = sqrt(1 - 0.9 anisotropy)",
    ),
    Parameter(
        "Rotation",
        "Rotation",
        "FLOAT",
        0.0,
        (0.0, 1.0),
        (0.0, 0.5),
        unit="turns",
        tooltip="Turns the direction of the anisotropy; 1 is a full turn",
    ),
    Parameter(
        "Distribution",
        "Distribution",
        "INT",
        0,
        (0, 1),
        (0, 1),
        tooltip="Distribution of the micronormals. GGX has the longer tails",
        choices=("GGX", "Beckmann"),
    ),
    Parameter(
        "Quality",
        "Quality",
        "INT",
        1,
        (0, 3),
        (0, 3),
        tooltip="How further bounces are computed. Single leaves them out. Fitted adds lobes from "
        "tables, without noise; but glass that the camera does not see takes a walk, and very "
        "rough GGX glass has Single's noise. Walk follows a few random walks and smooths their "
        "exits. Exact has no bias but the most noise, and finds lights only by hitting them. "
        "Fitted becomes Walk for another Model, for Bounce Only, for anisotropic glass and "
        "matte surfaces, and for glass of an IOR below 1.05 or above 2.5",
        choices=("Single", "Fitted", "Walk", "Exact"),
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Model",
        "Model",
        "INT",
        0,
        (0, 2),
        (0, 2),
        tooltip="How heights enter the chance to leave after a bounce. Height-correlated: arriving "
        "and leaving light share the height of the facet. Height-uncorrelated: they do not, and "
        "the result is reciprocal. Height-tracked: a path carries its height from bounce to bounce "
        "(Heitz et al. 2016)",
        choices=("height-correlated", "height-uncorrelated", "height-tracked"),
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "BounceOnly",
        "Bounce Only",
        "INT",
        0,
        (0, 64),
        (0, 8),
        unit="bounces",
        tooltip="0 shows all bounces, k shows bounce k alone, for study. A number above Max "
        "Bounces shows bounce Max Bounces",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "MaxBounces",
        "Max Bounces",
        "INT",
        16,
        (1, 64),
        (4, 32),
        unit="bounces",
        tooltip="Light ends after this many bounces on the microsurface",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Tolerance",
        "Tolerance",
        "FLOAT",
        0.001,
        (0.0, 1.0),
        (0.0, 0.02),
        tooltip="Bounces that carry less than this part of the arriving light are left out",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Walks",
        "Walks",
        "INT",
        4,
        (1, 16),
        (1, 8),
        unit="walks",
        tooltip="Random walks at each shading point, in Walk. More have less noise and take "
        "longer. Glass that the camera does not see directly takes one",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Kernel",
        "Kernel",
        "FLOAT",
        0.3,
        (0.05, 1.0),
        (0.2, 0.6),
        unit="rad",
        tooltip="Half-width of the lobe around each walk's exit, in Walk. Wider has less noise and "
        "a softer shape",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Normal",
        "Normal",
        "NORMAL",
        (0.0, 0.0, 0.0),
        (-1.0, 1.0),
        (-1.0, 1.0),
        tooltip="Normal of the surface; when unlinked or zero, the shading normal",
    ),
    Parameter(
        "Tangent",
        "Tangent",
        "TANGENT",
        (0.0, 0.0, 0.0),
        (-1.0, 1.0),
        (-1.0, 1.0),
        tooltip="Direction of the anisotropy; when unlinked or zero, around the object's Z axis",
    ),
)

# The parameters that are the same for every kind of material, by identifier.
SHARED: dict[str, Parameter] = {parameter.identifier: parameter for parameter in _OF_ALL_KINDS}

CONDUCTOR: tuple[Parameter, ...] = (
    Parameter(
        "BaseColor",
        "Base Color",
        "COLOR",
        (0.617, 0.577, 0.540),
        (0.0, 1.0),
        (0.0, 1.0),
        tooltip="Colour of the metal seen straight on: its reflectance at normal incidence. "
        "Used by the F82 tint",
    ),
    Parameter(
        "EdgeTint",
        "Edge Tint",
        "COLOR",
        (0.695, 0.726, 0.770),
        (0.0, 1.0),
        (0.4, 1.0),
        tooltip="Tint of the reflectance near 82 degrees, on top of the base colour. "
        "Used by the F82 tint",
    ),
    Parameter(
        "Fresnel",
        "Fresnel",
        "INT",
        0,
        (0, 1),
        (0, 1),
        tooltip="What gives each reflection its colour",
        choices=("F82 tint", "n and k"),
        panel=FRESNEL_PANEL,
    ),
    Parameter(
        "IOR",
        "IOR",
        "VECTOR",
        (2.757, 2.513, 2.231),
        (0.0, 100.0),
        (0.1, 5.0),
        tooltip="Index of refraction n for red, green and blue. Used by n and k",
        panel=FRESNEL_PANEL,
    ),
    Parameter(
        "Extinction",
        "Extinction",
        "VECTOR",
        (3.867, 3.404, 3.009),
        (0.0, 100.0),
        (1.0, 10.0),
        tooltip="Extinction coefficient k for red, green and blue. Used by n and k",
        panel=FRESNEL_PANEL,
    ),
    *_OF_ALL_KINDS,
)

DIELECTRIC: tuple[Parameter, ...] = (
    Parameter(
        "Color",
        "Color",
        "COLOR",
        (1.0, 1.0, 1.0),
        (0.0, 1.0),
        (0.8, 1.0),
        tooltip="Tint of the glass: what is left of the light after each bounce. White loses none",
    ),
    Parameter(
        "IOR",
        "IOR",
        "FLOAT",
        1.5,
        (0.01, 100.0),
        (1.0, 2.5),
        tooltip="Index of refraction inside over that outside; the surface's normals point outside",
    ),
    *_OF_ALL_KINDS,
)

DIFFUSE: tuple[Parameter, ...] = (
    Parameter(
        "Color",
        "Color",
        "COLOR",
        (0.8, 0.8, 0.8),
        (0.0, 1.0),
        (0.0, 0.95),
        tooltip="Albedo of the facets: what is left of the light after each bounce. Further "
        "bounces deepen the colour",
    ),
    *_OF_ALL_KINDS,
)
