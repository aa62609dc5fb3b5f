# SPDX-License-Identifier: GPL-3.0-or-later
"""Does a job in the other Blender: renders all variants, evaluates them, writes the reports."""

import datetime
import json
import os
import platform
import time
from pathlib import Path

import bpy

from ..core.cost.advice import recommendation
from ..core.cost.page import to_html
from ..core.cost.plan import REFERENCE_FACTOR, Options, Variant, planned_variants, reference_variant
from ..core.cost.plot import draw_plot, svg
from ..core.cost.results import TOO_SHORT, Cost, CostReport, Measured, Setting
from ..core.cost.statistics import reference_noise, split_error
from ..core.cost.tables import to_csv, to_json, to_text
from .page_pictures import PagePictures
from .reference_cache import load_reference, store_reference
from .renderer import Rendered, Renderer

# Far from the seeds of the rounds, which count from 1.
_REFERENCE_SEEDS = (1_000_001, 1_000_002)
# The reports. The last one is written after all others.
_FILES = {
    "page": "cost.html",
    "csv": "cost.csv",
    "text": "cost.txt",
    "plot": "cost.svg",
    "json": "cost.json",
}


def run(job_file: str) -> None:
    """Do the job in a JSON file, and tell how far it is in the file `progress` beside it."""
    path = Path(job_file)
    job = json.loads(path.read_text("utf-8"))
    options = Options.from_dict(job["options"])
    progress = path.with_name("progress")
    bpy.ops.wm.open_mainfile(filepath=job["copy"], load_ui=False, use_scripts=job["use_scripts"])
    scene = bpy.data.scenes[job["scene"]]
    renderer = Renderer(scene, job["view_layer"], options, path.parent)
    samples = renderer.samples
    half = max(2, (options.reference_samples or REFERENCE_FACTOR * samples) // 2)
    variants = planned_variants(options)
    references = load_reference(job["cache"])
    kept = references is not None
    notes = list(job["notes"])
    if renderer.held:
        notes.append(
            f"Keyframes and drivers of {', '.join(renderer.held)} were off in the copy: each "
            "variant sets its own values, what it does not set stays as it is at this frame."
        )
    total = 1 + len(variants) * options.rounds * (samples + 1) + (0 if kept else 2 * half)
    tell = _Teller(progress, total)

    if references is None:
        renderer.show(reference_variant(options.reference))
        references = []
        for number, seed in enumerate(_REFERENCE_SEEDS, 1):
            tell.start(f"Reference, {number} of 2")
            references.append(renderer.render(half, seed, tell.during).picture)
            tell.finish(half)
        if job["cache"] and not store_reference(job["cache"], references):
            notes.append(f"The reference is not kept: {job['cache']} cannot be written.")
    # Before the long part, so that a render border that shows nothing is reported early.
    _check_light(references)
    renders = _render_rounds(renderer, variants, options.rounds, tell)
    tell.start("Writing the report")
    measured = [_evaluated(v, renders[v.key], references, samples) for v in variants]
    shown = {}
    for key, pairs in renders.items():
        pictures = [full.picture for _, full in pairs]
        shown[key] = pictures[0], sum(pictures) / len(pictures)
    quick = [m.title for m in measured if not m.is_timed]
    if quick:
        notes.append(f"Too short to be timed: {', '.join(quick)}. Give more samples.")
    height, width = references[0].shape[:2]
    setting = Setting(
        file=job["file"],
        scene=scene.name,
        frame=scene.frame_current,
        width=width,
        height=height,
        samples=samples,
        rounds=options.rounds,
        error=options.error,
        reference=reference_variant(options.reference).title,
        reference_samples=2 * half,
        reference_noise=reference_noise(references),
        reference_kept=kept,
        date=datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
        hardware=_hardware(scene),
        memory_source=_memory_source(renders),
        notes=tuple(notes),
    )
    reference = 0.5 * (references[0] + references[1])
    pictures = PagePictures(scene, path.parent, reference, shown)
    _write(job["output"], setting, measured, pictures)


def _render_rounds(
    renderer: Renderer, variants: list[Variant], rounds: int, tell: "_Teller"
) -> dict[str, list[tuple[Rendered, Rendered]]]:
    """Return by key, for each round, a render of one sample and one of all samples.

    Each round goes through all variants, so a load on the machine falls on all of them.
    """
    tell.start("Warm-up")
    renderer.show(variants[0])
    renderer.render(1, 0)
    tell.finish(1)
    renders: dict[str, list[tuple[Rendered, Rendered]]] = {v.key: [] for v in variants}
    for seed in range(1, rounds + 1):
        for variant in variants:
            tell.start(f"{variant.title}, round {seed} of {rounds}")
            renderer.show(variant)
            one = renderer.render(1, seed)
            full = renderer.render(renderer.samples, seed, tell.during)
            renders[variant.key].append((one, full))
            tell.finish(renderer.samples + 1)
    return renders


def _evaluated(
    variant: Variant,
    renders: list[tuple[Rendered, Rendered]],
    references: "list[numpy.ndarray]",
    samples: int,
) -> Measured:
    more = samples - 1
    cost = Cost(
        wall=tuple(max(TOO_SHORT, (full.wall - one.wall) / more) for one, full in renders),
        processor=tuple(
            max(TOO_SHORT, (full.processor - one.processor) / more) for one, full in renders
        ),
        start=tuple(max(0.0, one.wall - (full.wall - one.wall) / more) for one, full in renders),
        memory=max(full.memory for _, full in renders) or _process_peak(),
    )
    split = split_error([full.picture for _, full in renders], references)
    return Measured(variant.key, variant.title, variant.family, samples, cost, split)


def _write(
    folder: str,
    setting: Setting,
    measured: list[Measured],
    pictures: PagePictures,
) -> None:
    files = {kind: str(Path(folder, name)) for kind, name in _FILES.items()}
    sentence = recommendation(measured, setting.error)
    report = CostReport(setting, tuple(measured), sentence, files)
    contents = {
        "page": to_html(report, pictures.drawn).encode(),
        "csv": to_csv(report).encode(),
        "text": to_text(report).encode(),
        "plot": svg(draw_plot(report)).encode(),
        "json": to_json(report).encode(),
    }
    for kind, content in contents.items():
        try:
            Path(files[kind]).write_bytes(content)
        except OSError as error:
            reason = error.strerror or error
            raise RuntimeError(
                f"{files[kind]} cannot be written: {reason}. Choose another output folder"
            ) from error


def _check_light(references: "list[numpy.ndarray]") -> None:
    if not (references[0] * references[1]).mean() > 0.0:
        raise RuntimeError("The reference is black: check camera, lights and render border")


class _Teller:
    """Writes how far it is to a file, a line at a time."""

    def __init__(self, path: Path, total: int) -> None:
        """Start; `total` is the number of all samples."""
        self._path, self._total = path, total
        self._begin, self._done, self._text = time.monotonic(), 0, ""

    def start(self, text: str) -> None:
        """Tell what comes next."""
        self._text = text
        self.during(0)

    def during(self, samples: int) -> None:
        """Tell how many of its samples are done."""
        done = self._done + samples
        spent = time.monotonic() - self._begin
        left = spent * (self._total - done) / done if done else None
        line = json.dumps({"part": done / self._total, "text": self._text, "left": left})
        with open(self._path, "a", encoding="utf-8") as stream:
            print(line, file=stream)

    def finish(self, samples: int) -> None:
        """Tell that all of its samples are done."""
        self._done += samples
        self.during(0)


def _hardware(scene: bpy.types.Scene) -> dict[str, str]:
    import _cycles

    named = [device[0] for device in _cycles.available_devices("CPU") if device[1] == "CPU"]
    threads = scene.render.threads if scene.render.threads_mode == "FIXED" else os.cpu_count()
    return {
        "Processor": named[0] if named else platform.processor() or "unknown",
        "Threads": str(threads),
        "System": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "Blender": bpy.app.version_string,
    }


def _process_peak() -> float | None:
    """Return the peak memory of this process so far in megabytes, None on Windows."""
    try:
        import resource
    except ImportError:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024.0**2 if platform.system() == "Darwin" else 1024.0)


def _memory_source(renders: dict[str, list[tuple[Rendered, Rendered]]]) -> str:
    if all(full.memory for pairs in renders.values() for _, full in pairs):
        return "Cycles' own count of its peak, in whole megabytes"
    if _process_peak() is None:
        return "not measured"
    return "the peak of the whole process so far"
