# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what each change that made the shaders faster gains; writes docs/benchmarks/gains.md.

`make gains` times today's shader with and without the change. A replacement in the source, or a
parameter, undoes the change.
"""

import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

import bpy

from addon.material.group import material_group, script_node
from addon.material.node import new_material
from addon.material.script import compile_source
from scenes import pictures, variants
from scenes.timing import SampleTimes, time_samples
from tools.figures.cache import ROOT, write
from tools.figures.markdown import table, wrap

from .machine import this_machine
from .shaders import replaced_source

FILE = ROOT / "docs" / "benchmarks" / "gains.md"
ROUNDS = 5
SAMPLES = 16
PERCENTAGE = 50  # of the showcase's width and height


@dataclass(frozen=True)
class Change:
    """One change, and how to undo it.

    what    -- the change in words
    stage   -- "metal", "glass 0.5" or "glass 0.7" (its roughness)
    quality -- measured with this Quality
    patches -- (text of today's shader, text without the change)
    values  -- (parameter's identifier, value) without the change
    """

    what: str
    stage: str
    quality: str
    patches: tuple[tuple[str, str], ...] = ()
    values: tuple[tuple[str, float], ...] = ()


_ANY_FRAME = "  if (surface.isotropic)\n    return any_frame(z);\n"
_ASKED = "  if (!is_left_alone(z, view, Ng))\n    z = corrected"
_UNSEEN = "    if (!is_seen())\n      return unseen_conductor(frame, surface, material, further);\n"
_STRETCHED = "vector w = arrival.stretched;"
_ONE_WALK = 'is_one_walk(accuracy, fitted || !raytype("camera"))'

CHANGES = (
    Change("metal that the camera does not see has two closures instead of three", "metal",
           "Fitted", ((_UNSEEN, ""),)),
    Change("isotropic surfaces take any tangent", "metal", "Fitted", ((_ANY_FRAME, ""),)),
    Change("curves are evaluated only if a normal must be bent", "metal", "Fitted",
           ((_ASKED, "  z = corrected"),)),
    Change("no further bounces if less than the tolerance is missing", "metal", "Fitted",
           values=(("Tolerance", 0.0),)),
    Change("walks end, or never start, if less than the tolerance is missing", "metal", "Walk",
           values=(("Tolerance", 0.0),)),
    Change("the stretched view is computed once per vertex", "metal", "Walk",
           ((_STRETCHED, "vector w = normalize(stretch(surface, arrival.v));"),)),
    Change("glass that the camera does not see takes one walk", "glass 0.5", "Fitted",
           ((_ONE_WALK, "is_one_walk(accuracy, 0)"), ("if (fitted && is_seen())", "if (fitted)"))),
    Change("glass up to alpha 0.3 has Cycles' refraction and no facets", "glass 0.5", "Fitted",
           (("#define WIDEST_WHOLE_GGX 0.3", "#define WIDEST_WHOLE_GGX 0"),)),
    Change("rougher glass has 5 facets instead of 10", "glass 0.7", "Fitted",
           (("#define FITTED_FACETS 5", "#define FITTED_FACETS 10"),)),
    Change("glass that the camera does not see takes one walk", "glass 0.5", "Walk",
           ((_ONE_WALK, "is_one_walk(accuracy, 0)"),)),
)  # fmt: skip


def kind_of(stage: str) -> str:
    """The material that a stage is made of."""
    return "CONDUCTOR" if stage == "metal" else "DIELECTRIC"


def opened(stage: str) -> list[variants.Material]:
    """Open the showcase with all its metals GGX, or with glass of one roughness instead of them."""
    pictures.open_scene("showcase")
    bpy.context.scene.render.resolution_percentage = PERCENTAGE
    metals = variants.find_materials()
    if stage == "metal":
        for metal in metals:
            metal.set("Distribution", "GGX")
        return metals
    ours = [metal.material for metal in metals]
    glass = new_material("DIELECTRIC", "Glass", Roughness=float(stage.split()[1]))
    for thing in bpy.context.scene.objects:
        for slot in thing.material_slots:
            if slot.material in ours:
                slot.material = glass
    return variants.find_materials()


def measure(stage: str) -> dict[Change, SampleTimes]:
    """Time all changes of a stage. Those of a quality share one run, with today's as "with"."""
    changes = [change for change in CHANGES if change.stage == stage]
    materials = opened(stage)
    script = script_node(material_group(kind_of(stage)))
    bytecodes = {
        change: compile_source(replaced_source(kind_of(stage), change.patches))
        for change in changes
    }
    today = script.bytecode, script.bytecode_hash

    def switch(quality: str, change: Change | None) -> None:
        script.bytecode, script.bytecode_hash = today
        if change and change.patches:
            # Cycles caches shaders by this hash.
            script.bytecode, script.bytecode_hash = bytecodes[change], f"{hash(change)}"
        for material in materials:
            material.set("Tolerance", material.kind.by_identifier["Tolerance"].default)
            for identifier, value in change.values if change else ():
                material.set(identifier, value)
        variants.use_quality(materials, quality)

    found = {}
    for quality in dict.fromkeys(change.quality for change in changes):
        some = [change for change in changes if change.quality == quality]
        switches = {"with": lambda quality=quality: switch(quality, None)}
        for change in some:
            switches[change.what] = lambda quality=quality, change=change: switch(quality, change)
        times = time_samples(bpy.context.scene, switches, samples=SAMPLES, rounds=ROUNDS)
        found |= dict.fromkeys(some, times)
    return found


def page(found: dict[Change, SampleTimes], machine: str) -> str:
    """The text of gains.md, with a row for each change."""
    rows = []
    for change, times in found.items():
        ratios = times.ratios(change.what, "with")
        middle = statistics.median(ratios)
        told = min(ratios) > 1.0 or max(ratios) < 1.0
        gained = f"{1.0 - 1.0 / middle:.0%}" if told else "no clear gain"
        spread = f"{middle:.2f} ({min(ratios):.2f} to {max(ratios):.2f})"
        rows.append((change.what, change.stage, change.quality, spread, gained))
    header = ("change", "showcase of", "Quality", "time without over with it", "gain")
    return wrap(f"""# What each change gained

`make gains` measured this on {machine}. It times today's shader with and without each change, by
the processor time of a sample. The numbers are the median and the range of {ROUNDS} rounds, in
which both take turns. A gain counts if all rounds agree. For what stratified walks gain in error,
see One walk on [the page of errors](README.md): it is not stratified.

{table(header, rows)}""")


def main() -> int:
    """Measure and write the page."""
    found: dict[Change, SampleTimes] = {}
    for stage in dict.fromkeys(change.stage for change in CHANGES):
        print(f"Timing the showcase of {stage} ...", file=sys.stderr, flush=True)
        found |= measure(stage)
    Path(FILE).parent.mkdir(parents=True, exist_ok=True)
    write(FILE, page(found, str(this_machine())))
    print(f"Wrote {FILE.name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
