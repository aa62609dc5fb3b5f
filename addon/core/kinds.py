# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of material that there are: their names and what they are made from."""

from dataclasses import dataclass

from .parameter import Parameter
from .parameters import CONDUCTOR, DIELECTRIC, DIFFUSE


@dataclass(frozen=True)
class Kind:
    """One kind of material.

    identifier -- its name in code, such as "CONDUCTOR"
    surface    -- what it is in plain words, such as "Rough metal"
    parameters -- the inputs of its shader and of its node group
    """

    identifier: str
    surface: str
    parameters: tuple[Parameter, ...]

    @property
    def label(self) -> str:
        """The last word of its name."""
        return self.identifier.title()

    @property
    def name(self) -> str:
        """The name of its node group, also shown in menus."""
        return f"Microbounce {self.label}"

    @property
    def shader(self) -> str:
        """The name of its OSL shader."""
        return f"microbounce_{self.identifier.lower()}"

    @property
    def by_identifier(self) -> dict[str, Parameter]:
        """Its parameters by their identifiers."""
        return {parameter.identifier: parameter for parameter in self.parameters}


KINDS: dict[str, Kind] = {
    kind.identifier: kind
    for kind in (
        Kind("CONDUCTOR", "Rough metal", CONDUCTOR),
        Kind("DIELECTRIC", "Rough glass", DIELECTRIC),
        Kind("DIFFUSE", "Rough matte surface", DIFFUSE),
    )
}


def kind_named(identifier: str) -> Kind:
    """Return the kind "CONDUCTOR", "DIELECTRIC" or "DIFFUSE"; raises ValueError for another."""
    if identifier not in KINDS:
        raise ValueError(f"The kind of material is {identifier!r}: use one of {', '.join(KINDS)}")
    return KINDS[identifier]
