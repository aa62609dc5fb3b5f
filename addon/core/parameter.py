# SPDX-License-Identifier: GPL-3.0-or-later
"""What the specification of a material parameter holds, and how values are checked against it."""

from dataclasses import dataclass
from numbers import Integral, Real

TYPES = ("COLOR", "FLOAT", "INT", "VECTOR", "NORMAL", "TANGENT")
VECTOR_TYPES = ("COLOR", "VECTOR", "NORMAL", "TANGENT")

Value = float | int | tuple[float, float, float]


@dataclass(frozen=True)
class Parameter:
    """One parameter of a material.

    identifier -- its name in the OSL shader
    label      -- its name on the node, as on Cycles' own node where that has it
    type       -- one of TYPES
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
    type: str
    default: Value
    legal: tuple[float, float]
    useful: tuple[float, float]
    unit: str = ""
    tooltip: str = ""
    choices: tuple[str, ...] = ()
    panel: str = ""

    def __post_init__(self) -> None:
        if self.type not in TYPES:
            raise ValueError(f"{self.identifier}: type {self.type!r} is not one of {TYPES}")
        if self.choices and self.legal != (0, len(self.choices) - 1):
            raise ValueError(f"{self.identifier}: {len(self.choices)} choices, legal {self.legal}")
        self.checked(self.default)

    @property
    def is_vector(self) -> bool:
        """True if a value is three numbers."""
        return self.type in VECTOR_TYPES

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
        wanted = Integral if self.type == "INT" else Real
        if not isinstance(value, wanted):
            noun = "a whole number" if self.type == "INT" else "a number"
            raise TypeError(f"{self.identifier} is {value!r}: give {noun}")
        self._check_range(value, value)
        return int(value) if self.type == "INT" else float(value)

    def _checked_vector(self, value: object) -> tuple[float, float, float]:
        iterable = hasattr(value, "__iter__") and not isinstance(value, str)
        components = tuple(value) if iterable else ()
        # A colour with alpha is what Blender's own colour properties hold.
        if self.type == "COLOR" and len(components) == 4:
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
