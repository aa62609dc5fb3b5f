# SPDX-License-Identifier: GPL-3.0-or-later
"""The variants of a scene that are rendered to measure what accuracy costs."""

from dataclasses import asdict, dataclass, field

from ..parameter import Parameter
from ..parameters import SHARED

STEPS = SHARED["Quality"].choices

REFERENCES = ("WALK", "EXACT")
# The settings of the references. Walk has less bias if its lobes are narrower.
_REFERENCE_SETTINGS = {
    "WALK": {"Quality": "Walk", "Walks": 16, "Kernel": 0.15, "MaxBounces": 64, "Tolerance": 0.0},
    "EXACT": {"Quality": "Exact", "MaxBounces": 64, "Tolerance": 0.0},
}
REFERENCE_TITLES = {
    "WALK": "Walk with 16 walks and a kernel of 0.15",
    "EXACT": "Exact",
}
# Unless asked otherwise, the reference has this many times the samples of a variant.
REFERENCE_FACTOR = 16


class PlanError(ValueError):
    """An option that makes no sense; the message names its value and the remedy."""


@dataclass(frozen=True)
class Variant:
    """One way to render the scene's materials.

    key      -- its name in files
    title    -- its name for people
    family   -- "step", "bounces", "walks", "kernel" or "cycles"
    settings -- the parameters that it overrides, by identifier
    native   -- whether Cycles' own closures take the place of ours
    osl      -- whether Open Shading Language is on
    """

    key: str
    title: str
    family: str
    settings: dict[str, object] = field(default_factory=dict)
    native: bool = False
    osl: bool = True


@dataclass(frozen=True)
class Options:
    """The options of a measurement. Raises PlanError for a value that makes no sense.

    samples           -- of a picture, 2 or more; 0 means the scene's
    percentage        -- of the scene's width and height, 1 to 100; 0 means the scene's
    steps             -- of the ladder, out of STEPS
    bounces           -- limits of the bounces on the microsurface, in Walk
    walks, kernels    -- numbers of walks and radii of the lobe, in Walk
    baselines         -- whether Cycles' own closures are rendered, with OSL on and off
    rounds            -- how often each is rendered and timed, 2 or more, each with its own seed
    reference         -- "WALK", or "EXACT" if paths can hit all lights of the scene
    reference_samples -- of the reference, 4 or more; 0 means REFERENCE_FACTOR times a variant's
    error             -- target of the times to an error, relative, above 0
    region            -- x0, y0, x1, y1 in parts of the picture from its lower left corner;
                         None means the scene's render border, if it has one
    """

    samples: int = 64
    percentage: int = 50
    steps: tuple[str, ...] = STEPS
    bounces: tuple[int, ...] = (1, 2, 4, 8, 16)
    walks: tuple[int, ...] = ()
    kernels: tuple[float, ...] = ()
    baselines: bool = True
    rounds: int = 3
    reference: str = "WALK"
    reference_samples: int = 0
    error: float = 0.02
    region: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        _need(self.samples == 0 or self.samples >= 2, "samples", self.samples, "2 or more")
        _need(0 <= self.percentage <= 100, "percentage", self.percentage, "1 to 100")
        _need(self.rounds >= 2, "rounds", self.rounds, "2 or more: one picture shows no noise")
        enough = self.reference_samples == 0 or self.reference_samples >= 4
        _need(enough, "reference samples", self.reference_samples, "4 or more")
        _need(0.0 < self.error < 1.0, "error", self.error, "a part above 0 and below 1")
        _need(self.reference in REFERENCES, "reference", self.reference, "WALK or EXACT")
        for step in self.steps:
            _need(step in STEPS, "step", step, ", ".join(STEPS))
        for name, values in (
            ("MaxBounces", self.bounces),
            ("Walks", self.walks),
            ("Kernel", self.kernels),
        ):
            for value in values:
                _checked(SHARED[name], value)
        if self.region is not None:
            x0, y0, x1, y1 = self.region
            inside = 0.0 <= x0 < x1 <= 1.0 and 0.0 <= y0 < y1 <= 1.0
            _need(inside, "region", self.region, "0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1")
        if not planned_variants(self):
            raise PlanError("Nothing is to be rendered: choose a step or Cycles' own closures")

    def as_dict(self) -> dict[str, object]:
        """Return the options as JSON takes them."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, object]) -> "Options":
        """Return the options that as_dict() gave."""
        return cls(
            **{
                key: tuple(value) if isinstance(value, list) else value
                for key, value in data.items()
            }
        )


def planned_variants(options: Options) -> list[Variant]:
    """Return the variants to render, each once, the qualities first."""
    variants = [Variant(step.lower(), step, "step", {"Quality": step}) for step in options.steps]
    for family, identifier, values, title in (
        ("bounces", "MaxBounces", options.bounces, "Walk, {:d} bounces"),
        ("walks", "Walks", options.walks, "Walk, {:d} walks"),
        ("kernel", "Kernel", options.kernels, "Walk, kernel {:g}"),
    ):
        for value in dict.fromkeys(values):
            name = title.format(value)
            if value == 1:
                name = name.removesuffix("s")
            settings = {"Quality": "Walk", identifier: value}
            variants.append(Variant(f"{family}_{value:g}", name, family, settings))
    if options.baselines:
        variants.append(Variant("cycles_osl", "Cycles' own, OSL on", "cycles", native=True))
        variants.append(
            Variant("cycles_svm", "Cycles' own, OSL off", "cycles", native=True, osl=False)
        )
    return variants


def reference_variant(reference: str) -> Variant:
    """Return what "WALK" or "EXACT" stands for as a reference."""
    title = REFERENCE_TITLES[reference]
    return Variant("reference", title, "reference", _REFERENCE_SETTINGS[reference])


def overridden(options: Options) -> tuple[str, ...]:
    """Return the parameters, by identifier, that the reference or a variant overrides."""
    shown = [reference_variant(options.reference), *planned_variants(options)]
    return tuple(dict.fromkeys(name for variant in shown for name in variant.settings))


def _checked(parameter: Parameter, value: object) -> None:
    try:
        parameter.checked(value)
    except (TypeError, ValueError) as error:
        raise PlanError(str(error)) from None


def _need(right: bool, name: str, value: object, remedy: str) -> None:
    if not right:
        raise PlanError(f"{name.capitalize()} cannot be {value}: give {remedy}")
