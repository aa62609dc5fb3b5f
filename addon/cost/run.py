# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts a measurement in another Blender, follows it, and takes its report."""

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

import bpy

from ..child_blender import ChildBlender
from ..core.cost.plan import Options
from ..core.lamps import exact_warning
from ..core.run import Progress, RunError, wait_for
from ..material.script import osl_compiler_available
from ..scene.exact import enabled_lamps
from .reference_cache import cache_file
from .renderer import placed_nodes


class CostError(RunError):
    """The measurement cannot be made or failed; the message says why and what to do."""


class CostRun:
    """A measurement that is under way; close() it whatever happens, or use it with `with`."""

    def __init__(
        self,
        scene: bpy.types.Scene,
        layer: bpy.types.ViewLayer,
        options: Options,
        output: str,
        unchanged: bool = False,
    ) -> None:
        """Check everything, save a copy of the file and start.

        `output` is the folder for the reports; "//" means beside the file. `unchanged` says that
        the scene is as in the file, if Blender itself does not know. Raises CostError.
        """
        _need_measurable(scene)
        folder = output_folder(output)
        kept = cache_file(scene, layer.name, options, unchanged)
        notes = _notes(scene, layer, options, kept)
        self._child: ChildBlender | None = None
        try:
            self._folder = Path(tempfile.mkdtemp(prefix="microbounce_cost_"))
        except OSError as error:
            raise CostError(f"No folder for temporary files: {error}. Make room") from error
        try:
            job = {
                "copy": _saved_copy(self._folder),
                "file": bpy.path.basename(bpy.data.filepath) or "a file that was never saved",
                "scene": scene.name,
                "view_layer": layer.name,
                "options": options.as_dict(),
                "cache": kept,
                "output": str(folder),
                "notes": notes,
                "use_scripts": bpy.context.preferences.filepaths.use_scripts_auto_execute,
            }
            self._start(job)
            self._report = folder / "cost.json"
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "CostRun":
        """Return itself."""
        return self

    def __exit__(self, *error: object) -> None:
        """End it, if it has not ended."""
        self.close()

    def advance(self) -> bool:
        """Return whether the other Blender is at work."""
        return self._child.running

    def progress(self) -> Progress:
        """Return how far it is."""
        try:
            lines = (self._folder / "progress").read_text("utf-8").splitlines()
            return Progress(**json.loads(lines[-1]))
        except (OSError, IndexError, ValueError):  # not started, or a line is half written
            return Progress()

    def result(self) -> dict[str, object]:
        """Return the report, as CostReport.as_dict() has it, after it has ended.

        Raises CostError if it failed.
        """
        reason = self._child.failure()
        if reason:
            raise CostError(f"The measurement failed: {reason}")
        return json.loads(self._report.read_text("utf-8"))

    def close(self) -> None:
        """End the other Blender, if it runs, and remove the temporary files."""
        if self._child is not None:
            self._child.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _start(self, job: dict[str, object]) -> None:
        path = self._folder / "job.json"
        path.write_text(json.dumps(job), "utf-8")
        try:
            self._child = ChildBlender("cost.measure", [str(path)], self._folder / "user")
        except OSError as error:
            raise CostError(f"The other Blender does not start: {error}") from error


def measure(
    scene: bpy.types.Scene,
    layer: bpy.types.ViewLayer,
    options: Options,
    output: str,
    tell: Callable[[Progress], None] = lambda progress: None,
    unchanged: bool = False,
) -> dict[str, object]:
    """Measure and wait for it; return the report.

    `tell` gets each new state; the rest is as CostRun() has it. Raises CostError.
    """
    with CostRun(scene, layer, options, output, unchanged) as run:
        return wait_for(run, tell)


def _need_measurable(scene: bpy.types.Scene) -> None:
    """Raise CostError if nothing can be measured in a scene."""
    if not osl_compiler_available():
        raise CostError(
            "This Blender was built without Open Shading Language: use one from blender.org"
        )
    if scene.camera is None:
        raise CostError(f"The scene '{scene.name}' has no camera: add one")
    try:
        placed_nodes()
    except RuntimeError as error:
        raise CostError(str(error)) from None


def output_folder(output: str) -> Path:
    """Make the folder for the reports, and return it. Raises CostError if it cannot be written.

    "//" in a file that was never saved is a folder for temporary files.
    """
    if output.startswith("//") and not bpy.data.filepath:
        folder = Path(tempfile.gettempdir(), output[2:])
    else:
        folder = Path(os.path.abspath(bpy.path.abspath(output)))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        reason = error.strerror or error
        raise CostError(f"{folder} cannot be written: {reason}. Choose another folder") from error
    return folder


def _notes(
    scene: bpy.types.Scene, layer: bpy.types.ViewLayer, options: Options, kept: str
) -> tuple[str, ...]:
    """Return the notes on a measurement. Raises CostError if it has no reference."""
    notes = [
        "Denoiser, adaptive sampling, path guiding, light threshold, compositor and sequencer "
        "were off; rendered on the processor, in a copy of the file."
    ]
    direct, indirect = scene.cycles.sample_clamp_direct, scene.cycles.sample_clamp_indirect
    if direct or indirect:
        notes.append(
            f"All pictures, the reference too, are clamped as in the scene: direct {direct:g}, "
            f"indirect {indirect:g} (0 is off)."
        )
    missed = exact_warning(enabled_lamps(layer))
    if missed and options.reference == "EXACT":
        raise CostError(f"Exact is no reference here: take Walk. {missed}")
    if missed and "Exact" in options.steps:
        notes.append(missed)
    if not scene.cycles.shading_system:
        notes.append("Open Shading Language is off in the scene; in the copy it was on.")
    if not kept:
        notes.append("The reference was not kept, because the file may have unsaved changes.")
    return tuple(notes)


def _saved_copy(folder: Path) -> str:
    path = str(folder / "copy.blend")
    try:
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True, check_existing=False)
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ")
        raise CostError(f"No copy of the file can be saved: {reason}. Make room") from error
    return path
