# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the asset library, with a material for each preset, into build/assets.

Blender 4.5 builds it so that both versions open it. `make assets` and `make addon` call it.
"""

import argparse
import hashlib
import sys
import uuid
from pathlib import Path

from addon.core.kinds import KINDS
from addon.core.presets.catalogue import presets, problems
from addon.core.presets.files import Preset
from scenes.leave import leave

from .repack import repack

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "assets"
BLEND = "microbounce.blend"
CATALOGUE_FILE = "blender_assets.cats.txt"
CATALOGUES = {
    "CONDUCTOR": "Microbounce/Metals",
    "DIELECTRIC": "Microbounce/Glasses and Liquids",
    "DIFFUSE": "Microbounce/Matte Surfaces",
}
# Blender finds a catalogue by its UUID, so this must stay the same in all versions.
_NAMESPACE = uuid.UUID("6d1f8f0e-0b5c-5c1e-9a57-1a9c5b3f7d42")
_SOURCES = ("addon", "osl", "tools/release/assets.py", "tools/release/repack.py")


def catalogue_id(kind: str) -> str:
    """Return the UUID of a kind's catalogue."""
    return str(uuid.uuid5(_NAMESPACE, CATALOGUES[kind]))


def digest() -> str:
    """Return the digest of the sources that the library is built from."""
    found = hashlib.sha256()
    for source in _SOURCES:
        path = ROOT / source
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in files:
            if file.suffix in (".py", ".toml", ".webp", ".osl", ".h"):
                found.update(file.relative_to(ROOT).as_posix().encode())
                found.update(file.read_bytes())
    return found.hexdigest()


def is_current(folder: Path) -> bool:
    """Return whether `folder` holds a library built from today's sources."""
    stamp = _stamp(folder)
    files = (folder / BLEND, folder / CATALOGUE_FILE, stamp)
    return all(file.is_file() for file in files) and stamp.read_text(encoding="utf-8") == digest()


def build(folder: Path) -> Path:
    """Build the library into `folder` and return the path of its .blend file.

    Closes the open file without saving it. Raises RuntimeError if a preset is damaged or a picture
    is missing, and OSError if the folder cannot be written.
    """
    import bpy

    if problems():
        raise RuntimeError("\n".join(problems()))
    _stamp(folder).unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    materials = {_material(preset) for preset in presets()}
    blend = folder / BLEND
    # Writes only the materials and what they need: nothing of the window or this machine.
    bpy.data.libraries.write(str(blend), materials, fake_user=True, compress=True)
    repack(blend)
    lines = ["VERSION 1", ""]
    for kind, path in CATALOGUES.items():
        lines.append(f"{catalogue_id(kind)}:{path}:{path.replace('/', '-')}")
    (folder / CATALOGUE_FILE).write_text("\n".join(lines) + "\n", encoding="utf-8")
    _stamp(folder).write_text(digest(), encoding="utf-8")
    return blend


def _stamp(folder: Path) -> Path:
    """Return the path of the file beside `folder` that keeps digest()."""
    return folder.with_suffix(".stamp")


def _material(preset: Preset) -> object:
    """Return a material of the preset's values, marked as an asset."""
    from addon.presets.apply import preset_material

    material = preset_material(preset)
    material.asset_mark()
    data = material.asset_data
    data.description = f"{preset.description}. Values: {preset.source.title}, {preset.source.url}"
    data.author = "Microbounce contributors"
    data.license = f"GPL-3.0-or-later; the values: {preset.source.licence}"
    data.catalog_id = catalogue_id(preset.kind)
    for tag in (KINDS[preset.kind].label, *preset.tags):
        data.tags.new(tag, skip_if_exists=True)
    _set_preview(material, preset)
    return material


def _set_preview(material: object, preset: Preset) -> None:
    import bpy
    import numpy as np

    from addon.presets.icons import picture_path

    path = picture_path(preset.identifier)
    if not path.is_file():
        raise RuntimeError(f"{path} is missing: render it with `make previews`")
    image = bpy.data.images.load(str(path))
    try:
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        preview = material.preview_ensure()
        preview.image_size = tuple(image.size)
        preview.image_pixels_float.foreach_set(pixels)
    finally:
        bpy.data.images.remove(image)


def main(arguments: list[str] | None = None) -> int:
    """Build the library unless it is up to date; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder of the library")
    folder = parser.parse_args(arguments).output.resolve()
    if is_current(folder):
        print(f"{folder / BLEND} is up to date")
        return 0
    import bpy

    if bpy.app.version >= (5, 0, 0):
        print(
            f"Blender {bpy.app.version_string} would make a library that 4.5 cannot open: "
            "use `make assets`",
            file=sys.stderr,
        )
        return 1
    try:
        blend = build(folder)
    except (OSError, RuntimeError) as error:
        print(f"The asset library was not built: {error}", file=sys.stderr)
        return 1
    print(f"{blend}: {len(presets())} materials, {blend.stat().st_size / 1024:.0f} KiB")
    return 0


if __name__ == "__main__":
    leave(main())
