# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the presets' pictures into addon/previews: by default those that are missing or old.

A picture is old if the preset's values or the scene's script changed after it was rendered.
manifest.json beside the pictures holds a fingerprint of both for each picture.
"""

import argparse
import hashlib
import json
import sys
from pathlib import Path

import bpy
from tqdm import tqdm

from addon.core.presets.catalogue import presets, problems
from addon.core.presets.files import Preset
from addon.presets import icons as preset_icons
from addon.presets.apply import NEW_VALUES, preset_material
from scenes.leave import leave
from scenes.render import messages_to

from . import scene as preview_scene

ROOT = Path(__file__).resolve().parents[2]
LIMIT = 300_000  # bytes of all pictures together
_QUALITY = 82  # of WebP, in percent


def manifest_path() -> Path:
    """Return the path of the file that holds the pictures' fingerprints."""
    return preset_icons.FOLDER / "manifest.json"


def fingerprint(preset: Preset) -> str:
    """Return a digest of what decides on the preset's picture: its values and the scene."""
    values = sorted({**NEW_VALUES[preset.kind], **preset.values}.items())
    scene = Path(preview_scene.__file__).read_text(encoding="utf-8")
    return hashlib.sha256(f"{preset.kind} {values} {scene}".encode()).hexdigest()[:16]


def known_fingerprints() -> dict[str, str]:
    """Return the fingerprints of the rendered pictures by preset identifier."""
    try:
        return json.loads(manifest_path().read_text(encoding="utf-8"))["pictures"]
    except FileNotFoundError:
        return {}


def outdated() -> list[Preset]:
    """Return the presets whose picture is missing or old."""
    known = known_fingerprints()
    return [
        preset
        for preset in presets()
        if known.get(preset.identifier) != fingerprint(preset)
        or not preset_icons.picture_path(preset.identifier).is_file()
    ]


def leftovers() -> list[Path]:
    """Return the pictures that belong to no preset."""
    wanted = {preset_icons.picture_path(preset.identifier) for preset in presets()}
    return sorted(set(preset_icons.FOLDER.glob("*.webp")) - wanted)


def render(chosen: list[Preset], log: Path) -> None:
    """Render the pictures of these presets. Blender's own messages go to the file `log`.

    Raises RuntimeError if Blender wrote no picture.
    """
    if not chosen:
        return
    scene, ball = preview_scene.build()
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.quality = "WEBP", "RGB", _QUALITY
    preset_icons.FOLDER.mkdir(parents=True, exist_ok=True)
    log.parent.mkdir(parents=True, exist_ok=True)
    for preset in (steps := tqdm(chosen, desc="Rendering", unit="picture")):
        steps.set_postfix_str(preset.name)
        material = preset_material(preset)
        ball.data.materials[0] = material
        path = preset_icons.picture_path(preset.identifier)
        path.unlink(missing_ok=True)
        scene.render.filepath = str(path)
        with messages_to(log):
            bpy.ops.render.render(write_still=True)
        bpy.data.materials.remove(material)
        if not path.is_file():
            raise RuntimeError(f"Blender wrote no {path}; its messages are in {log}")
        _note(preset)


def _note(preset: Preset) -> None:
    """Add the preset's fingerprint to the manifest; drop presets that no longer exist."""
    known = {**known_fingerprints(), preset.identifier: fingerprint(preset)}
    names = sorted(item.identifier for item in presets() if item.identifier in known)
    content = {"command": "make previews", "pictures": {name: known[name] for name in names}}
    manifest_path().write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def complaints() -> list[str]:
    """Return what is wrong with the pictures, each with its remedy."""
    found = [f"{item.identifier}: no picture of today's values" for item in outdated()]
    found += [f"{path.name}: belongs to no preset, delete it" for path in leftovers()]
    size = sum(path.stat().st_size for path in preset_icons.FOLDER.glob("*.webp"))
    if size > LIMIT:
        found.append(f"The pictures take {size} bytes and may take {LIMIT}: lower their quality")
    return [*found, *problems()]


def main(arguments: list[str] | None = None) -> int:
    """Do what the command line asks for; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.previews", description=__doc__.splitlines()[0]
    )
    task = parser.add_mutually_exclusive_group()
    task.add_argument("--check", action="store_true", help="render nothing, name what is wrong")
    task.add_argument("--all", action="store_true", help="render all pictures anew")
    task.add_argument("--only", metavar="NAME", help="render this one, such as conductor/gold")
    options = parser.parse_args(arguments)
    if not options.check:
        chosen = list(presets()) if options.all else outdated()
        if options.only:
            chosen = [item for item in presets() if options.only in (item.identifier, item.name)]
            if not chosen:
                parser.error(f"there is no preset {options.only!r}")
        try:
            render(chosen, ROOT / "build" / "previews.log")
        except (OSError, RuntimeError) as error:
            print(f"The pictures were not rendered: {error}", file=sys.stderr)
            return 1
        for path in leftovers():
            path.unlink()
    if options.only:
        return 0
    for complaint in (found := complaints()):
        print(complaint, file=sys.stderr)
    if any(": no picture" in complaint for complaint in found):
        print("`make previews` renders what is missing", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    leave(main())
