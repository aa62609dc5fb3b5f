# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds dist/microbounce-<version>.zip with Blender's own extension builder and validates it.

Run with a Python that has bpy; `make addon` does.
"""

import argparse
import importlib.util
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from . import assets

ROOT = Path(__file__).resolve().parents[2]


def builder_script() -> Path:
    """Return the path of Blender's script that builds extensions, which lies in the bpy package.

    Raises FileNotFoundError if this Python has no bpy or bpy has no builder.
    """
    spec = importlib.util.find_spec("bpy")
    if spec is None or spec.origin is None:
        raise FileNotFoundError(f"{sys.executable} has no bpy: run `make addon`")
    package = Path(spec.origin).parent
    found = sorted(package.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not found:
        raise FileNotFoundError(f"{package} has no extension builder (bl_pkg/cli/blender_ext.py)")
    return found[-1]


def stage(folder: Path, library: Path | None = None) -> None:
    """Copy the zip's content into `folder`, which must be empty.

    library -- the folder of the asset library that goes into it, None for a zip without one
    Raises FileNotFoundError if the repository has no shader.
    """
    shutil.copytree(
        ROOT / "addon",
        folder,
        ignore=shutil.ignore_patterns("__pycache__", "*.pyc"),
        dirs_exist_ok=True,
    )
    shutil.copy2(ROOT / "LICENSE", folder)
    shaders = sorted((ROOT / "osl").glob("*.osl"))
    if not shaders:
        raise FileNotFoundError(f"{ROOT / 'osl'} has no .osl file")
    for source in (*shaders, *sorted((ROOT / "osl").rglob("*.h"))):
        target = folder / "osl" / source.relative_to(ROOT / "osl")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)
    if library is not None:
        (folder / "assets").mkdir()
        for name in (assets.BLEND, assets.CATALOGUE_FILE):
            shutil.copy2(library / name, folder / "assets")


def build(output: Path, work: Path, library: Path | None = None) -> Path:
    """Build and validate the zip in folder `output`, staged in folder `work`; return its path.

    library -- as in stage()
    Raises subprocess.CalledProcessError if Blender's builder or validator refuses.
    """
    folder = work / "addon"
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    stage(folder, library)
    manifest = tomllib.loads((folder / "blender_manifest.toml").read_text(encoding="utf-8"))
    archive = output / f"{manifest['id']}-{manifest['version']}.zip"
    output.mkdir(parents=True, exist_ok=True)
    archive.unlink(missing_ok=True)
    builder = [sys.executable, str(builder_script())]
    subprocess.run(
        [*builder, "build", "--source-dir", str(folder), "--output-filepath", str(archive)],
        check=True,
    )
    subprocess.run([*builder, "validate", str(archive)], check=True)
    return archive


def main() -> int:
    """Build into dist/ or the folder of --output; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "dist", help="folder of the zip")
    parser.add_argument(
        "--work", type=Path, default=ROOT / "build", help="folder for the files to pack"
    )
    parser.add_argument(
        "--library", type=Path, default=assets.FOLDER, help="folder of the asset library"
    )
    arguments = parser.parse_args()
    library = arguments.library.resolve()
    if not assets.is_current(library):
        print("The zip has no asset library: `make assets` builds one with Blender 4.5")
        library = None
    try:
        archive = build(arguments.output.resolve(), arguments.work.resolve(), library)
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        print(f"The extension was not built: {error}", file=sys.stderr)
        return 1
    print(f"{archive}: {archive.stat().st_size / 1024:.0f} KiB, validated")
    return 0


if __name__ == "__main__":
    sys.exit(main())
