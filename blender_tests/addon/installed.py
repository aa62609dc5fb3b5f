# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses all that an installed extension registers; runs in a Blender of its own, without a window.

It knows the extension by the name of its package alone, so that nothing of the repository helps.
"""

import contextlib
import importlib
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryFile
from typing import TextIO

import bpy

from blender_tests.addon.support import small_scene


class Installed:
    """The installed extension, with what it returned.

    ran   -- what each operator returned, by its name
    drawn -- the names of the panels and menus that were drawn
    """

    def __init__(self, module: str, folder: Path) -> None:
        """Enable the extension in a small scene that is saved in `folder`, with OSL off."""
        self._module, self._folder = module, folder
        self._scene, self._sphere = small_scene(osl=False)
        self._scene.render.resolution_x = self._scene.render.resolution_y = 16
        bpy.ops.preferences.addon_enable(module=module)  # the factory settings switched it off
        self.ran: dict[str, list[str]] = {}
        self.drawn: set[str] = set()

    def use(self) -> None:
        """Run every operator once, and draw every panel before, in between and at the end."""
        self._draw()
        self._run("enable_osl")
        self._materials()
        self._draw()
        self._presets()
        self._conversions()
        self._reports()
        self._library()
        self._draw()

    def command(self, *argv: str) -> tuple[int, object]:
        """Return the exit code and the JSON of a subcommand, as Blender calls it."""
        run = importlib.import_module(f"{self._module}.command")._run
        with TemporaryFile("w+", encoding="utf-8") as printed, _standard_output(printed):
            code = run([*argv, "--json"])
            printed.seek(0)
            return code, json.load(printed)

    def _run(self, name: str, /, **arguments: object) -> None:
        result = getattr(bpy.ops.microbounce, name)(**arguments)
        self.ran.setdefault(name, []).extend(result)

    def _materials(self) -> None:
        for kind in ("DIELECTRIC", "DIFFUSE", "CONDUCTOR"):
            self._run("add_material", kind=kind)
        with _editor("ShaderNodeTree") as space:
            space.pin, space.node_tree = True, self._sphere.active_material.node_tree
            self._run("add_node", kind="DIFFUSE")

    def _presets(self) -> None:
        self._run("apply_preset", identifier="conductor/gold")
        self._run("search_preset", identifier="conductor/copper")
        self._run("apply_finish", identifier="finish/brushed")
        self._run("set_choice", parameter="Quality", value="Walk")
        self._run("save_preset", name="Smoke")
        (path,) = Path(bpy.utils.user_resource("SCRIPTS")).rglob("Smoke*")
        self._run("apply_user_preset", filepath=str(path))
        self._draw()
        self._run("remove_user_preset", filepath=str(path))

    def _conversions(self) -> None:
        for name in ("to_native", "to_microbounce"):
            for dry_run in (True, False):
                self._run(name, scope="ALL", dry_run=dry_run)
        for group in bpy.data.node_groups:
            group["microbounce_stamp"] = "of an older version"
        self._run("update_materials")

    def _reports(self) -> None:
        self._run("analyse", tolerance=1.0)
        self._run("apply_analysis")
        self._run("check_render")
        bpy.ops.wm.save_as_mainfile(filepath=str(self._folder / "smoke.blend"))
        self._run("check_farm", prove=True)
        quick = {"bounces": "", "baselines": False, "rounds": 2, "reference_samples": 4}
        self._run("measure_cost", samples=2, percentage=100, steps="Fitted", **quick)
        self._run("show_cost_plot")
        self._run("clear_cost_cache")

    def _library(self) -> None:
        (self._folder / "microbounce.blend").touch()  # nobody opens it
        stored = bpy.context.preferences.addons[self._module].preferences
        stored.library_path = str(self._folder)
        self._run("register_library")
        self._draw()
        self._run("unregister_library")

    def _draw(self) -> None:
        """Draw all panels and menus where they are shown, into a layout that knows Blender's."""
        for ui_type, space_type in (("ShaderNodeTree", "NODE_EDITOR"), ("PROPERTIES",) * 2):
            with _editor(ui_type) as space:
                if ui_type == "ShaderNodeTree":
                    material = self._sphere.active_material
                    space.pin, space.node_tree = True, material and material.node_tree
                for cls in drawn_classes():
                    if getattr(cls, "bl_space_type", space_type) != space_type:
                        continue
                    if not hasattr(cls, "poll") or cls.poll(bpy.context):
                        cls.draw(_Drawn(cls), bpy.context)
                        self.drawn.add(cls.__name__)


def drawn_classes() -> list[type]:
    """Return the panels and menus that the extension registered."""
    found = [getattr(bpy.types, name) for name in dir(bpy.types) if "MICROBOUNCE_" in name]
    return [cls for cls in found if issubclass(cls, (bpy.types.Panel, bpy.types.Menu))]


class _Drawn:
    """Stands in for a panel or menu: it has a layout, and all that its class has."""

    def __init__(self, cls: type) -> None:
        self._cls, self.layout = cls, Layout()

    def __getattr__(self, name: str) -> object:
        return getattr(self._cls, name)


class Layout:
    """Takes what Blender's own layout takes: functions, arguments, icons, operators and menus."""

    def __getattr__(self, name: str) -> object:
        """Return the function `name`, which checks its arguments; raises KeyError for another."""
        parameters = bpy.types.UILayout.bl_rna.functions[name].parameters

        def call(*values: object, **options: object) -> object:
            for key, value in options.items():
                kinds = parameters[key].enum_items if parameters[key].type == "ENUM" else ()
                assert not kinds or value in kinds, f"{name}({key}={value!r})"
            if name.startswith("prop"):
                assert values[1] in values[0].bl_rna.properties, values[1]
            if name == "menu":
                assert hasattr(bpy.types, values[0]), values[0]
            if name.startswith("operator"):
                return _Button(values[0])
            return (self, self) if name == "panel_prop" else self

        return call

    def __setattr__(self, name: str, value: object) -> None:
        """Take a property of Blender's layout."""
        assert name in bpy.types.UILayout.bl_rna.properties, name


class _Button:
    """Takes the properties that its operator has."""

    def __init__(self, idname: str) -> None:
        module, name = idname.split(".")
        known = getattr(getattr(bpy.ops, module), name).get_rna_type().properties
        object.__setattr__(self, "_known", set(known.keys()))

    def __setattr__(self, name: str, value: object) -> None:
        assert name in self._known, name


@contextlib.contextmanager
def _standard_output(file: TextIO) -> Iterator[None]:
    """Let what is printed go to a file, also where the process's own stream is taken."""
    sys.stdout.flush()
    saved = os.dup(1)
    os.dup2(file.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(saved, 1)
        os.close(saved)


@contextlib.contextmanager
def _editor(ui_type: str) -> Iterator[bpy.types.Space]:
    """Let the context be that of an editor; yield its space."""
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    before = area.ui_type
    area.ui_type = ui_type
    region = next(region for region in area.regions if region.type == "WINDOW")
    try:
        with bpy.context.temp_override(window=window, area=area, region=region):
            yield area.spaces.active
    finally:
        area.ui_type = before
