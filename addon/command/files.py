# SPDX-License-Identifier: GPL-3.0-or-later
"""The .blend file that a subcommand works on: opening it, and saving only if that was asked."""

import argparse
import os
from pathlib import Path

import bpy

from .output import CommandError


def add_file_argument(parser: argparse.ArgumentParser) -> None:
    """Add `--file`."""
    parser.add_argument(
        "--file", type=Path, metavar="FILE", help="the .blend file, unless it is named before"
    )


def add_save_arguments(parser: argparse.ArgumentParser) -> None:
    """Add `--save`, `--save-as` and `--overwrite`."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--save", action="store_true", help="save the file in its place")
    where.add_argument("--save-as", type=Path, metavar="FILE", help="save as another file")
    parser.add_argument(
        "--overwrite", action="store_true", help="let --save-as replace a file that is there"
    )


def add_dry_run_argument(parser: argparse.ArgumentParser) -> None:
    """Add `--dry-run`, which goes with none of the arguments that save."""
    parser.add_argument(
        "--dry-run", action="store_true", help="say what would be done, change nothing"
    )


def open_file(arguments: argparse.Namespace) -> Path:
    """Open the file of `--file`, or take the one that is open, and return its path.

    Python scripts in the file are not run. Raises CommandError if there is no such .blend file.
    """
    if arguments.file is None:
        if not bpy.data.filepath:
            raise CommandError("No file is open: name one with --file FILE.blend")
        return Path(bpy.data.filepath)
    path = Path(os.path.abspath(arguments.file))
    if not path.exists():
        raise CommandError(f"{path} does not exist: check the path")
    if not path.is_file():
        noun = "a folder" if path.is_dir() else "no file"
        raise CommandError(f"{path} is {noun}: name a .blend file")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ")
        raise CommandError(f"{path} cannot be opened: {reason}. Name a .blend file") from error
    return path


def check_target(arguments: argparse.Namespace) -> None:
    """Raise CommandError if the file could not be saved as asked; call it before the work."""
    target = arguments.save_as
    if getattr(arguments, "dry_run", False) and (target is not None or arguments.save):
        raise CommandError("A dry run saves nothing: leave out --dry-run, or what saves")
    if target is None:
        return
    target = Path(os.path.abspath(target))
    if target.suffix != ".blend":
        raise CommandError(f"{target} is no name of a .blend file: let it end in .blend")
    if not target.parent.is_dir():
        raise CommandError(f"The folder {target.parent} does not exist: make it first")
    if target.exists() and not arguments.overwrite:
        raise CommandError(f"{target} is there already: add --overwrite to replace it")


def save_file(arguments: argparse.Namespace) -> str:
    """Save as `--save` or `--save-as` ask; return the path, "" if neither was given.

    Raises CommandError if the file cannot be written, or a newer Blender's would lose data.
    """
    if arguments.save_as is None and not arguments.save:
        return ""
    check_target(arguments)
    target = os.path.abspath(arguments.save_as or bpy.data.filepath)
    made_by, this = tuple(bpy.data.version[:2]), bpy.app.version[:2]
    if arguments.save and made_by > this:
        raise CommandError(
            f"{target} is of Blender {made_by[0]}.{made_by[1]}, and this is {this[0]}.{this[1]}, "
            "which would lose what is newer: use that version, or --save-as another file"
        )
    try:
        # Blender 4.5 would forget, in background, that the file was compressed.
        bpy.ops.wm.save_as_mainfile(
            filepath=target, check_existing=False, compress=_is_compressed(bpy.data.filepath)
        )
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ")
        raise CommandError(
            f"{target} cannot be written: {reason}. Make it writable, or save elsewhere"
        ) from error
    return target


def _is_compressed(path: str) -> bool:
    try:
        with open(path, "rb") as file:
            return file.read(7) != b"BLENDER"
    except OSError:  # it was moved away meanwhile
        return False


def saved(target: str) -> str:
    """Return the line for people that says what save_file() did."""
    return f"Saved {target}" if target else "Nothing was saved: add --save or --save-as FILE"
