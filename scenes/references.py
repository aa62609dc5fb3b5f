# SPDX-License-Identifier: GPL-3.0-or-later
"""The oracle's reference pictures of a whole sphere or slab, with their settings in Blender."""

from dataclasses import dataclass

from .pictures import Widths

# Samples of each of two renders. Glass of alpha 1 has more noise: its reflections are the dim part
# of its light, and its transmission has narrow lobes.
SAMPLES = {"sun": 64, "back": 192, "inside": 128, "slab": 64}
SAMPLES_OF_DIM_REFLECTIONS = 256
SAMPLES_OF_WIDE_REFRACTIONS = 768
# The kinds in the references' names. White metal and glass of IOR 1.5 lose no light.
NAMES = {"CONDUCTOR": "white", "DIELECTRIC": "glass", "DIFFUSE": "diffuse"}
OTHER_MODELS = ("height-uncorrelated", "height-tracked")


@dataclass(frozen=True)
class Case:
    """A reference picture, with its settings in Blender."""

    light: str
    kind: str
    widths: Widths
    distribution: str = "GGX"
    model: str = "height-correlated"

    @property
    def reference(self) -> str:
        """The name of its file."""
        model = self.model.removeprefix("height-")
        parts = [self.light, NAMES[self.kind], self.distribution.lower(), self.widths.name]
        return "_".join(parts if model == "correlated" else [*parts, model])

    @property
    def samples(self) -> int:
        """Samples per pixel of a render of all bounces."""
        if self.kind == "DIELECTRIC" and self.widths.alpha_x == 1.0:
            if self.light == "sun":
                return SAMPLES_OF_DIM_REFLECTIONS
            if self.light == "back":
                return SAMPLES_OF_WIDE_REFRACTIONS
        return SAMPLES[self.light]

    @property
    def values(self) -> dict[str, object]:
        """The values of the material by identifier."""
        return {"Distribution": self.distribution, "Model": self.model, **self.widths.inputs}


def _isotropic(light: str, kind: str, *alphas: float, distribution: str = "GGX") -> list[Case]:
    return [Case(light, kind, Widths(a, a), distribution) for a in alphas]


def _sphere(light: str, kind: str) -> list[Case]:
    rough = Widths(1.0, 1.0)
    return [
        *_isotropic(light, kind, 0.3, 1.0),
        *_isotropic(light, kind, 0.3, 1.0, distribution="Beckmann"),
        Case(light, kind, Widths(1.0, 0.1)),
        *(Case(light, kind, rough, model=model) for model in OTHER_MODELS),
    ]


CASES = [
    *(Case("sun", "CONDUCTOR", Widths(1.0, 1.0), model=model) for model in OTHER_MODELS),
    *_sphere("sun", "DIFFUSE"),
    *_sphere("sun", "DIELECTRIC"),
    *_sphere("back", "DIELECTRIC"),
    *_isotropic("inside", "DIELECTRIC", 0.5),
    *_isotropic("slab", "DIELECTRIC", 0.1, 0.3, 0.6, 1.0),
]
