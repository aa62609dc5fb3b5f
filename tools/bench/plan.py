# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of the benchmark: scenes, variants, samples and rounds. Needs no Blender."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

SINGLE, FITTED, WALK, EXACT = "Single", "Fitted", "Walk", "Exact"
UNCORRELATED, TRACKED = "Walk, uncorrelated", "Walk, height-tracked"
ONE_WALK, WHOLE_WALK = "One walk", "Whole walk"
CYCLES, CYCLES_SVM = "Cycles, OSL on", "Cycles, OSL off"

# The quality of variants that show Cycles' own closures.
NATIVE = "Cycles"

Value = float | int | str | tuple[float, float, float]


@dataclass(frozen=True)
class Variant:
    """One way to render a scene.

    quality -- of our materials, or NATIVE for Cycles' own closures with the same values
    values  -- (parameter's identifier, value) of our materials
    patch   -- name of a change of the shader's source in shaders.py; "" for none
    percentage -- of the scene's resolution; 0 for the scene's own percentage
    """

    name: str
    quality: str
    osl: bool = True
    values: tuple[tuple[str, Value], ...] = ()
    patch: str = ""
    percentage: int = 0


MODELS = {
    UNCORRELATED: Variant(UNCORRELATED, WALK, values=(("Model", "height-uncorrelated"),)),
    TRACKED: Variant(TRACKED, WALK, values=(("Model", "height-tracked"),)),
}
_OURS = (
    Variant(SINGLE, SINGLE),
    Variant(FITTED, FITTED),
    Variant(WALK, WALK),
    *MODELS.values(),
)
_EXACT = (Variant(EXACT, EXACT),)
_PLAIN = (
    Variant(ONE_WALK, WALK, values=(("Walks", 1),), patch="one candidate"),
    Variant(WHOLE_WALK, WALK, patch="whole walk"),
)
_CYCLES = (Variant(CYCLES, NATIVE), Variant(CYCLES_SVM, NATIVE, osl=False))
UNDER_SUN = (*_OURS, *_PLAIN, *_CYCLES)
UNDER_WIDE_LIGHT = (*_OURS, *_EXACT, *_CYCLES)

BOUNCES = WALK_COUNTS = (1, 2, 4, 8, 16)
PERCENTAGES = (25, 50, 100)


def swept(variant: Variant, parameter: str, values: Iterable[int]) -> tuple[Variant, ...]:
    """One copy of `variant` for each of `values` of a parameter, or of "percentage"."""
    if parameter == "percentage":
        return tuple(replace(variant, name=f"{variant.name}, {v} %", percentage=v) for v in values)
    return tuple(
        replace(
            variant,
            name=f"{variant.name}, {parameter} {v}",
            values=(*variant.values, (parameter, v)),
        )
        for v in values
    )


# Pixels of each stage's picture at its full size.
PIXELS = {
    "slab": 64**2,
    "sun": 64**2,
    "back": 64**2,
    "furnace": 64**2,
    "showcase": 512 * 336,
    "mesh": 128 * 80,
}


@dataclass(frozen=True)
class Scene:
    """One scene with all its variants.

    stage     -- what stage.py opens: "slab", "sun", "back", "furnace", "showcase" or "mesh"
    kind      -- of its material
    values    -- of its materials, by identifier
    reference -- a name in blender_tests/references; "white" for radiance 1, "render" for a render
                 of Exact, "" for none
    others    -- (variant's name, reference) of variants with a reference of their own
    tops      -- samples of each round; the first two rounds have the most
    reference_samples -- of each of the two renders that make a reference
    percentage        -- of the scene's own resolution
    is_sweep          -- its variants differ in one number only
    """

    name: str
    title: str
    stage: str
    kind: str
    variants: tuple[Variant, ...]
    tops: tuple[int, ...]
    values: tuple[tuple[str, Value], ...] = ()
    reference: str = ""
    others: tuple[tuple[str, str], ...] = ()
    reference_samples: int = 0
    percentage: int = 100
    is_sweep: bool = False

    @property
    def directional(self) -> bool:
        """Whether a sun without size lights it."""
        return self.stage in ("slab", "sun", "back")

    @property
    def paired(self) -> int:
        """Samples of the pictures that separate bias from noise. The first two rounds keep one."""
        return min(self.tops[:2])

    def work(self, variant: Variant | None, samples: int) -> int:
        """Paths that a render starts, for the progress bar. None stands for the reference."""
        percentage = variant.percentage if variant and variant.percentage else self.percentage
        return samples * PIXELS[self.stage] * percentage**2 // 100**2

    @property
    def whole_work(self) -> int:
        """Paths of all rounds and of the reference's two renders."""
        rounds = sum(self.work(variant, sum(self.tops)) for variant in self.variants)
        return rounds + self.work(None, 2 * self.reference_samples)

    def shortened(self, tops: tuple[int, ...], reference_samples: int = 0) -> "Scene":
        """The same scene with other numbers of samples."""
        return replace(self, tops=tops, reference_samples=reference_samples)

    def repeated(self, times: int) -> "Scene":
        """The same scene with `times` as many rounds. Kept results of the first ones stay valid."""
        return replace(self, tops=self.tops * times)

    def with_variants(self, *names: str) -> "Scene":
        """The same scene with only these of its variants."""
        return replace(self, variants=tuple(v for v in self.variants if v.name in names))


# The first round shows the whole curve, the second separates bias from noise. Five give times.
FULL_TOPS = (1024, 128, 32, 32, 32)
LARGE_TOPS = (256, 128, 16, 16, 16)
SWEEP_TOPS = (32, 32, 32, 32, 32)

_WHITE = (1.0, 1.0, 1.0)
_GOLD = (("BaseColor", (0.95, 0.75, 0.35)), ("EdgeTint", (0.98, 0.95, 0.75)))
_ROUGH_METAL = (("BaseColor", _WHITE), ("EdgeTint", _WHITE), ("Roughness", 1.0))


def _slab(alpha: float) -> Scene:
    return Scene(
        f"slab_{alpha:g}",
        f"Single Slab of glass, α = {alpha:g}",
        "slab",
        "DIELECTRIC",
        UNDER_SUN,
        FULL_TOPS,
        values=(("Roughness", math.sqrt(alpha)),),
        reference=f"slab_glass_ggx_{alpha:g}",
    )


def _ball(name: str, kind: str, title: str) -> Scene:
    reference = f"sun_{name}_ggx_1"
    return Scene(
        f"sun_{name}",
        f"{title} under the sun, α = 1",
        "sun",
        kind,
        UNDER_SUN,
        FULL_TOPS,
        values=_ROUGH_METAL if kind == "CONDUCTOR" else (("Roughness", 1.0),),
        reference=reference,
        others=((UNCORRELATED, f"{reference}_uncorrelated"), (TRACKED, f"{reference}_tracked")),
    )


SLABS = tuple(_slab(alpha) for alpha in (0.1, 0.3, 0.6, 1.0))
BALLS = (
    _ball("white", "CONDUCTOR", "White metal"),
    _ball("diffuse", "DIFFUSE", "White matte ball"),
    _ball("glass", "DIELECTRIC", "Glass, reflection"),
)
FURNACES = (
    Scene("furnace_gold", "Gold in a white furnace, α = 0.5", "furnace", "CONDUCTOR",
          UNDER_WIDE_LIGHT, FULL_TOPS, (*_GOLD, ("Roughness", math.sqrt(0.5))),
          "furnace_gold_ggx_0.5"),
    Scene("furnace_clay", "Clay in a white furnace, α = 1", "furnace", "DIFFUSE",
          UNDER_WIDE_LIGHT, FULL_TOPS, (("Color", (0.8, 0.5, 0.2)), ("Roughness", 1.0)),
          "furnace_clay_ggx_1"),
    Scene("furnace_glass", "Glass in a white furnace, α = 0.5", "furnace", "DIELECTRIC",
          UNDER_WIDE_LIGHT, FULL_TOPS, (("Roughness", math.sqrt(0.5)),), "white"),
)  # fmt: skip
# Cycles has only one bounce of Beckmann, so all metals of the showcase are GGX here.
SHOWCASE = Scene("showcase", "Showcase of metals, all GGX", "showcase", "CONDUCTOR",
                 UNDER_WIDE_LIGHT, LARGE_TOPS, (("Distribution", "GGX"),), "render",
                 reference_samples=4096, percentage=25)  # fmt: skip
MESH = Scene("mesh", "2 million triangles of metal", "mesh", "CONDUCTOR",
             UNDER_WIDE_LIGHT, LARGE_TOPS, (), "render", reference_samples=2048)  # fmt: skip

_WALK, _FITTED = Variant(WALK, WALK), Variant(FITTED, FITTED)
# Sweeps of one parameter, on scenes that are also measured above.
SWEEPS = {
    "bounces_showcase": replace(
        SHOWCASE, name="bounces_showcase", title="Bounce limit, showcase", tops=SWEEP_TOPS,
        reference="", reference_samples=0,
        variants=tuple(v for one in (_WALK, _FITTED) for v in swept(one, "MaxBounces", BOUNCES)),
        is_sweep=True),
    "bounces_slab": replace(
        SLABS[2], name="bounces_slab", title="Bounce limit, slab of α = 0.6", tops=SWEEP_TOPS,
        variants=tuple(v for one in (_WALK, _FITTED) for v in swept(one, "MaxBounces", BOUNCES)),
        is_sweep=True),
    "walks_white": replace(
        BALLS[0], name="walks_white", title="Walks, white metal, α = 1", tops=SWEEP_TOPS,
        variants=swept(_WALK, "Walks", WALK_COUNTS), others=(), is_sweep=True),
    "walks_slab": replace(
        SLABS[2], name="walks_slab", title="Walks, slab of α = 0.6", tops=SWEEP_TOPS,
        variants=swept(_WALK, "Walks", WALK_COUNTS), is_sweep=True),
    "sizes": replace(
        SHOWCASE, name="sizes", title="Image size, showcase", tops=(8,) * 5,
        reference="", reference_samples=0,
        variants=tuple(v for name in (SINGLE, FITTED, WALK, CYCLES)
                       for one in SHOWCASE.with_variants(name).variants
                       for v in swept(one, "percentage", PERCENTAGES)), is_sweep=True),
}  # fmt: skip

FULL = (*SLABS, *BALLS, *FURNACES, SHOWCASE, MESH, *SWEEPS.values())

# What `make bench-check` measures and `make bench` records: few scenes, few samples.
QUICK_ROUNDS = 7
QUICK = (
    replace(SHOWCASE, reference="").shortened((16,) * QUICK_ROUNDS).with_variants(
        SINGLE, FITTED, WALK, EXACT, CYCLES, CYCLES_SVM
    ),
    SLABS[2].shortened((16,) * QUICK_ROUNDS).with_variants(SINGLE, FITTED, WALK, ONE_WALK, CYCLES),
    BALLS[0].shortened((64,) * QUICK_ROUNDS).with_variants(SINGLE, FITTED, WALK, ONE_WALK, CYCLES),
    SWEEPS["bounces_showcase"].shortened((16,) * QUICK_ROUNDS).with_variants(
        "Walk, MaxBounces 2", "Walk, MaxBounces 16"
    ),
)  # fmt: skip

# All scenes with two rounds of few samples, to see that all of it works before a long run.
TRIAL = tuple(scene.shortened((4, 4), 16 if scene.reference_samples else 0) for scene in FULL)

PLANS = {"full": FULL, "quick": QUICK, "trial": TRIAL}


def levels(top: int) -> list[int]:
    """The numbers of samples at which an error is taken: 1, 2, 4 ... `top`, a power of two."""
    if top < 1 or top & (top - 1):
        raise ValueError(f"top is {top}: give a power of two, such as 64")
    return [1 << power for power in range(top.bit_length())]
