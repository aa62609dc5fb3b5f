# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: installs the extension, uses it in the window, and records what happens.

The arguments after `--` are two JSON files. The first has "archive" (the extension's zip), "folder"
(for pictures), "screen" (the file of Xvfb's screen, or "") and "seconds". The second is for the
result.
"""

import faulthandler
import json
import shutil
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parents[2]))
from tools.window import editors
from tools.window.editors import area, drawn, in_area, window
from tools.window.session import NODES, PROPERTIES, VIEW
from tools.window.watch import watch_panels

MODULE = "bl_ext.user_default.microbounce"

_PIXELS = 32
_EEVEE = "BLENDER_EEVEE" if bpy.app.version >= (5, 0, 0) else "BLENDER_EEVEE_NEXT"
# The preset that the search finds.
_SEARCHED = "Copper"

SETTINGS, RESULT = (Path(name) for name in sys.argv[sys.argv.index("--") + 1 :])
settings = json.loads(SETTINGS.read_text(encoding="utf-8"))
result: dict[str, object] = {"drawn": [], "ran": {}, "states": {}, "errors": [], "areas": {}}


def steps() -> Iterator[float]:
    """Run the session. Blender draws during the yielded seconds."""
    result["version"] = bpy.app.version_string
    result["installed"] = _install()
    _make_scene()
    # Before an editor shows the material, because its preview would render at the same time.
    result["centres"] = {engine: _rendered_centre(engine) for engine in ("EEVEE", "CYCLES")}
    yield from _as_installed()
    names = watch_panels(MODULE, result["drawn"], result["errors"], opened=True)
    result["panels"] = names
    yield from editors.workspace("Modeling")
    yield from _all_open()
    yield from editors.workspace("Layout")
    with bpy.context.temp_override(window=window()):
        bpy.ops.preferences.addon_disable(module=MODULE)
    yield from drawn()
    result["left"] = [name for name in dir(bpy.types) if "MICROBOUNCE" in name]


def _as_installed() -> Iterator[float]:
    """Look at the panels as installed, and find a preset by typing its name."""
    area(PROPERTIES).spaces.active.context = "MATERIAL"
    yield from drawn()
    _note("added")
    _run("apply_preset", VIEW, identifier="conductor/gold")
    yield from editors.show_nodes()
    _note("preset")
    editors.point(NODES)
    yield from drawn()
    with in_area(PROPERTIES):
        bpy.ops.microbounce.search_preset("INVOKE_DEFAULT")
    yield from drawn()
    editors.write(_SEARCHED)
    yield from drawn()
    _note("search")
    editors.press("RET")
    yield from drawn()
    _note("searched")


def _pictures() -> Iterator[float]:
    """Look at the presets' pictures in a large editor."""
    large = area(VIEW)
    large.ui_type = PROPERTIES
    large.spaces.active.context = "MATERIAL"
    bpy.context.window_manager.microbounce_presets_open = True
    yield from drawn()
    yield from editors.scroll_down(PROPERTIES, 17)
    _note("pictures")
    bpy.context.window_manager.microbounce_presets_open = False
    large.ui_type = VIEW
    yield from drawn()


def _all_open() -> Iterator[float]:
    """Press the buttons with all panels open, then undo."""
    yield from _pictures()
    area(PROPERTIES).spaces.active.context = "MATERIAL"
    yield from editors.show_nodes()
    # The zip may lack the library.
    library = bpy.ops.microbounce.register_library.poll()
    for name in ("analyse", "check_farm", "check_render", *["register_library"] * library):
        _run(name, PROPERTIES)
        yield from drawn()
    _note("checked")
    yield from editors.scroll_down(PROPERTIES, 40)
    _note("scrolled")
    if library:
        _run("unregister_library", PROPERTIES)
    editors.point(NODES)
    for name in ("to_native", "to_microbounce"):
        _run(name, PROPERTIES)
        yield from drawn()
        _note(name)
    for count in (1, 2):
        editors.press("Z", ctrl=True)
        yield from drawn()
        _note(f"undo{count}")
    area(PROPERTIES).spaces.active.context = "RENDER"
    yield from drawn()
    yield from editors.scroll_down(PROPERTIES, 40)
    _note("render")


def _install() -> list[str]:
    with bpy.context.temp_override(window=window()):
        bpy.ops.extensions.package_install_files(
            filepath=settings["archive"], repo="user_default", enable_on_install=True
        )
    return [name for name in bpy.context.preferences.addons.keys() if name == MODULE]  # noqa: SIM118


def _make_scene() -> None:
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_area(VIEW):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=2.0, segments=64, ring_count=32)
        bpy.ops.object.shade_smooth()
    _run("add_material", VIEW, kind="CONDUCTOR")
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(settings["folder"], "scene.blend")))
    window().scene.render.engine = "CYCLES"


def _run(name: str, ui_type: str, **arguments: object) -> None:
    """Press a button in an editor, with an undo step."""
    with in_area(ui_type):
        done = getattr(bpy.ops.microbounce, name)("EXEC_DEFAULT", True, **arguments)
    result["ran"][name] = sorted(done)


def _note(name: str) -> None:
    """Keep the screen, the places of the editors, and the material's nodes."""
    if settings["screen"]:
        shutil.copyfile(settings["screen"], Path(settings["folder"], f"{name}.xwd"))
    shown = {found.ui_type: found for found in window().screen.areas}
    result["areas"][name] = {
        ui_type: [found.x, found.y, found.width, found.height] for ui_type, found in shown.items()
    }
    material = window().view_layer.objects.active.active_material
    kinds = {node.name: node.bl_idname for node in material.node_tree.nodes}
    presets = [node.get("microbounce_preset") for node in material.node_tree.nodes]
    result["states"][name] = {"nodes": kinds, "presets": [one for one in presets if one]}


def _rendered_centre(engine: str) -> list[float]:
    """Render a small picture with `engine`; return the mean colour of its middle."""
    scene = window().scene
    before = scene.render.engine
    scene.render.engine = engine if engine == "CYCLES" else _EEVEE
    scene.render.resolution_x = scene.render.resolution_y = _PIXELS
    scene.cycles.samples = scene.eevee.taa_render_samples = 8
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(Path(settings["folder"], f"{engine}.exr"))
    bpy.ops.render.render(write_still=True)
    scene.render.engine = before
    return _centre(scene.render.filepath)


def _centre(path: str) -> list[float]:
    """Return the mean colour of a picture's middle."""
    pixels = list(bpy.data.images.load(path).pixels)
    middle = range(3 * _PIXELS // 8, 5 * _PIXELS // 8)
    chosen = [4 * (_PIXELS * y + x) for y in middle for x in middle]
    return [sum(pixels[i + channel] for i in chosen) / len(chosen) for channel in range(3)]


def _finish() -> None:
    RESULT.write_text(json.dumps(result), encoding="utf-8")
    bpy.ops.wm.quit_blender()


_running = steps()


def _next() -> float | None:
    try:
        return next(_running)
    except StopIteration:
        result["done"] = True
    except Exception:  # noqa: BLE001 - the result reports it
        result["errors"].append(traceback.format_exc())
    _finish()
    return None


# Prints where it hangs.
faulthandler.dump_traceback_later(settings["seconds"])
# Before Blender draws for the first time.
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.view.render_display_type = "NONE"
bpy.app.timers.register(_next, first_interval=editors.DRAW, persistent=True)
