# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: installs the extension, uses it in the window, and writes down what happened.

Arguments after `--`: a JSON file with "archive" (the extension's zip), "folder" (for pictures) and
"screen" (the file that is Xvfb's screen, "" where there is none); the JSON file for the result.
"""

import faulthandler
import json
import shutil
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path

import bpy

MODULE = "bl_ext.user_default.microbounce"

# Editors, by the names of their types.
NODES, PROPERTIES = "ShaderNodeTree", "PROPERTIES"

# Seconds in which Blender draws what has changed.
_DRAW = 1.5

_PIXELS = 32
_EEVEE = "BLENDER_EEVEE" if bpy.app.version >= (5, 0, 0) else "BLENDER_EEVEE_NEXT"

SETTINGS, RESULT = (Path(name) for name in sys.argv[sys.argv.index("--") + 1 :])
settings = json.loads(SETTINGS.read_text(encoding="utf-8"))
result: dict[str, object] = {"drawn": [], "ran": [], "errors": []}


def steps() -> Iterator[float]:
    """Do one thing after the other; each waits the yielded seconds, in which Blender draws."""
    result["version"] = bpy.app.version_string
    result["installed"] = _install()
    _make_scene()
    # Before an editor shows the material: its preview would be rendered at the same time.
    result["centres"] = {engine: _rendered_centre(engine) for engine in ("EEVEE", "CYCLES")}
    _open_and_watch_panels()
    area("VIEW_3D").ui_type = NODES
    area(NODES).spaces.active.show_region_ui = True
    area(PROPERTIES).spaces.active.context = "MATERIAL"
    yield from _drawn()  # a sidebar has tabs from then on
    sidebar = next(region for region in area(NODES).regions if region.type == "UI")
    sidebar.active_panel_category = "Microbounce"
    _use_operators()
    yield from _drawn()
    with in_area(NODES):
        bpy.ops.node.view_all()
    yield from _drawn()
    _take_picture()
    area(PROPERTIES).spaces.active.context = "OBJECT"
    area(NODES).ui_type = "VIEW_3D"
    yield from _drawn()
    with bpy.context.temp_override(window=window()):
        bpy.ops.preferences.addon_disable(module=MODULE)
    result["left"] = [name for name in dir(bpy.types) if "MICROBOUNCE" in name]


def _drawn() -> Iterator[float]:
    """Wait until Blender has drawn, and rendered its previews: changes in between may hang it."""
    yield _DRAW
    while bpy.app.is_job_running("RENDER_PREVIEW"):
        yield _DRAW


def window() -> bpy.types.Window:
    """Return Blender's one window; a timer's context has none."""
    return bpy.context.window_manager.windows[0]


def area(ui_type: str) -> bpy.types.Area:
    """Return the first editor of a type that is on the screen."""
    return next(area for area in window().screen.areas if area.ui_type == ui_type)


def in_area(ui_type: str) -> object:
    """Return a context manager in which operators see the main region of such an editor."""
    found = area(ui_type)
    region = next(region for region in found.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window(), area=found, region=region)


def _install() -> list[str]:
    with bpy.context.temp_override(window=window()):
        bpy.ops.extensions.package_install_files(
            filepath=settings["archive"], repo="user_default", enable_on_install=True
        )
    return [name for name in bpy.context.preferences.addons.keys() if name == MODULE]  # noqa: SIM118


def _open_and_watch_panels() -> None:
    """Register the panels again, open, and noting when they are drawn and what goes wrong."""
    classes = [cls for cls in _subclasses(bpy.types.Panel) if cls.__module__.startswith(MODULE)]
    result["panels"] = sorted(cls.__name__ for cls in classes)
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
    for cls in classes:
        cls.bl_options = set(getattr(cls, "bl_options", ())) - {"DEFAULT_CLOSED"}
        cls.draw = _watched(cls.__name__, cls.draw)
        bpy.utils.register_class(cls)


def _subclasses(cls: type) -> list[type]:
    """Return the classes that are registered, parents of panels before their children."""
    found = [sub for sub in cls.__subclasses__() if getattr(sub, "is_registered", False)]
    return sorted(found, key=lambda sub: hasattr(sub, "bl_parent_id"))


def _watched(name: str, draw: object) -> object:
    def watched(self: object, context: bpy.types.Context) -> None:
        try:
            draw(self, context)
        except Exception:
            result["errors"].append(f"{name}: {traceback.format_exc()}")
            raise
        if name not in result["drawn"]:
            result["drawn"].append(name)

    return watched


def _make_scene() -> None:
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_area("VIEW_3D"):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=2.0, segments=64, ring_count=32)
        bpy.ops.object.shade_smooth()
        _run("add_material", kind="CONDUCTOR")
    material = bpy.context.view_layer.objects.active.active_material
    result["node"] = sorted(node.name for node in material.node_tree.nodes)
    result["active"] = material.name


def _use_operators() -> None:
    """Press the buttons that this version of the extension has."""
    scene = window().scene
    scene.render.engine = "CYCLES"
    with in_area(PROPERTIES):
        _run("apply_preset", identifier="conductor/gold")
        _run("analyse")
        _run("check_render")
        _run("check_farm")


def _run(name: str, **arguments: object) -> None:
    if name in dir(bpy.ops.microbounce):
        done = getattr(bpy.ops.microbounce, name)("EXEC_DEFAULT", **arguments)
        result["ran"].append([name, sorted(done)])


def _take_picture() -> None:
    """Keep what the screen shows, and where on it the editors are."""
    if settings["screen"]:
        shutil.copyfile(settings["screen"], Path(settings["folder"], "screen.xwd"))
    result["areas"] = {
        name: [found.x, found.y, found.width, found.height]
        for name in (NODES, PROPERTIES)
        for found in [area(name)]
    }


def _rendered_centre(engine: str) -> list[float]:
    """Render the scene small with `engine`; return the mean colour of the picture's middle."""
    scene = window().scene
    scene.render.engine = engine if engine == "CYCLES" else _EEVEE
    scene.render.resolution_x = scene.render.resolution_y = _PIXELS
    scene.cycles.samples = scene.eevee.taa_render_samples = 8
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(Path(settings["folder"], f"{engine}.exr"))
    bpy.ops.render.render(write_still=True)
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
    except Exception:  # noqa: BLE001 - whatever it is, the session tells it and ends
        result["errors"].append(traceback.format_exc())
    _finish()
    return None


# Where it hangs, if it does.
faulthandler.dump_traceback_later(settings["seconds"])
# Before Blender draws for the first time.
bpy.context.preferences.view.show_splash = False
bpy.context.preferences.view.render_display_type = "NONE"
bpy.app.timers.register(_next, first_interval=_DRAW)
