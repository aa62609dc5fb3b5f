# SPDX-License-Identifier: GPL-3.0-or-later
"""The one specification of every material parameter.

Shader parameters, node-group sockets and documentation are made from this or tested against it.
"""

from dataclasses import dataclass
from numbers import Integral, Real

KINDS = ("COLOR", "FLOAT", "INT", "VECTOR", "NORMAL", "TANGENT")
VECTOR_KINDS = ("COLOR", "VECTOR", "NORMAL", "TANGENT")

Value = float | int | tuple[float, float, float]


@dataclass(frozen=True)
class Parameter:
    """One parameter of a material.

    identifier -- its name in the OSL shader
    label      -- its name on the node, as on Cycles' Metallic BSDF where that has it
    kind       -- one of KINDS
    default    -- a number, or three numbers; zero for NORMAL and TANGENT means "the surface's own"
    legal      -- smallest and largest value accepted; the node's limits
    useful     -- the range in which the parameter makes a visible, plausible difference
    unit       -- "" (plain number), "turns", "rad" or "bounces", "walks"
    tooltip    -- shown on the socket; for a choice it is followed by the meaning of each number
    choices    -- names of the values 0, 1, 2 ... of an INT that is a choice, else empty
    panel      -- name of the node's panel that shows it, "" for the top of the node
    """

    identifier: str
    label: str
    kind: str
    default: Value
    legal: tuple[float, float]
    useful: tuple[float, float]
    unit: str = ""
    tooltip: str = ""
    choices: tuple[str, ...] = ()
    panel: str = ""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"{self.identifier}: kind {self.kind!r} is not one of {KINDS}")
        if self.choices and self.legal != (0, len(self.choices) - 1):
            raise ValueError(f"{self.identifier}: {len(self.choices)} choices, legal {self.legal}")
        self.checked(self.default)

    @property
    def is_vector(self) -> bool:
        """True where a value is three numbers."""
        return self.kind in VECTOR_KINDS

    def checked(self, value: object) -> Value:
        """Return `value` in the form of this parameter: int, float, or a tuple of three floats.

        A choice is accepted by number or by its name. Raises TypeError for a wrong type or
        number of components and ValueError for a value that is not finite or outside `legal`.
        """
        if self.choices and isinstance(value, str):
            names = [name.lower() for name in self.choices]
            if value.lower() not in names:
                raise ValueError(f"{self.identifier} is {value!r}: use one of {self.choices}")
            return names.index(value.lower())
        if self.is_vector:
            return self._checked_vector(value)
        wanted = Integral if self.kind == "INT" else Real
        if not isinstance(value, wanted):
            noun = "a whole number" if self.kind == "INT" else "a number"
            raise TypeError(f"{self.identifier} is {value!r}: give {noun}")
        self._check_range(value, value)
        return int(value) if self.kind == "INT" else float(value)

    def _checked_vector(self, value: object) -> tuple[float, float, float]:
        iterable = hasattr(value, "__iter__") and not isinstance(value, str)
        components = tuple(value) if iterable else ()
        # A colour with alpha is what Blender's own colour properties hold.
        if self.kind == "COLOR" and len(components) == 4:
            components = components[:3]
        if len(components) != 3 or not all(isinstance(c, Real) for c in components):
            raise TypeError(f"{self.identifier} is {value!r}: give three numbers")
        for component in components:
            self._check_range(component, value)
        return tuple(float(c) for c in components)

    def _check_range(self, number: float, value: object) -> None:
        low, high = self.legal
        if not low <= number <= high:  # as for NaN, which compares false
            raise ValueError(f"{self.identifier} is {value!r}: it goes from {low:g} to {high:g}")

    @property
    def description(self) -> str:
        """The tooltip together with what each number of a choice means."""
        if not self.choices:
            return self.tooltip
        meanings = ", ".join(f"{number} {name}" for number, name in enumerate(self.choices))
        return f"{self.tooltip} ({meanings})"


FRESNEL_PANEL = "Fresnel"
BOUNCES_PANEL = "Multiple Bounces"

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
        tooltip="Stretches reflections along the tangent: the two alphas are alpha / a and "
        "alpha * a with a = sqrt(1 - 0.9 anisotropy)",
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
        2,
        (0, 3),
        (0, 3),
        tooltip="How the light of further bounces is found. Single leaves it out. Fitted is not "
        "made yet and takes Walk. Walk smooths the exits of a few walks. Exact has no bias and the "
        "most noise, and finds lights only by hitting them",
        choices=("Single", "Fitted", "Walk", "Exact"),
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Model",
        "Model",
        "INT",
        0,
        (0, 2),
        (0, 0),
        tooltip="How the heights of successive bounces depend on one another. Only 0 is made yet: "
        "1 and 2 print a message and use 0",
        choices=("height-correlated", "height-uncorrelated", "height-tracked"),
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
        tooltip="A walk ends after this many bounces on the microsurface",
        panel=BOUNCES_PANEL,
    ),
    Parameter(
        "Tolerance",
        "Tolerance",
        "FLOAT",
        0.001,
        (0.0, 1.0),
        (0.0, 0.02),
        tooltip="Further bounces are left out where the energy they still carry, as a part of the "
        "light that arrives, is below this",
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
        tooltip="Walks at every shading point in Walk: more have less noise and take longer",
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
        tooltip="Half-width of the lobe around the exit of each walk in Walk: wider has less noise "
        "and a softer shape",
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
