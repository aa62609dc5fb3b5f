# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets and finishes that the extension brings."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..kinds import KINDS, kind_named
from .files import FINISH, FOLDERS, Finish, Preset, PresetError, close_names, read

FOLDER = Path(__file__).resolve().parents[2] / "presets"


def presets(kind: str | None = None) -> tuple[Preset, ...]:
    """Return the presets of a kind, or all, by kind and name; raises ValueError for another kind.

    Files are read once, those of a kind when it is first asked for. One that cannot be used is left
    out, and `problems` tells of it.
    """
    kinds = KINDS if kind is None else (kind_named(kind).identifier,)
    return tuple(item for each in kinds for item in _read_folder(FOLDER / each.lower()).items)


def finishes(kind: str | None = None) -> tuple[Finish, ...]:
    """Return the finishes for a kind, or all, by name; raises ValueError for another kind."""
    found = _read_folder(FOLDER / FINISH).items
    if kind is None:
        return found
    kind_named(kind)
    return tuple(finish for finish in found if kind in finish.kinds)


def preset(identifier: str) -> Preset:
    """Return the preset of an identifier such as "conductor/gold"; raises PresetError."""
    return _found(identifier, presets(), "preset")


def finish(identifier: str) -> Finish:
    """Return the finish of an identifier such as "finish/brushed"; raises PresetError."""
    return _found(identifier, finishes(), "finish")


def problems() -> tuple[str, ...]:
    """Return what is wrong with the files that were left out, a text a file."""
    return tuple(text for name in FOLDERS for text in _read_folder(FOLDER / name).problems)


def clear_cache() -> None:
    """Forget what was read: the files are read again when they are next asked for."""
    _read_folder.cache_clear()


@dataclass(frozen=True)
class _Folder:
    items: tuple[Preset | Finish, ...]
    problems: tuple[str, ...]


@cache
def _read_folder(folder: Path) -> _Folder:
    items: list[Preset | Finish] = []
    wrong: list[str] = []
    paths = sorted(folder.glob("*.toml"))
    if not paths:
        wrong.append(f"{folder}: there are no presets here. Install the extension again.")
    for path in paths:
        try:
            items.append(read(path))
        except PresetError as error:
            wrong.append(str(error))
    return _Folder(tuple(sorted(items, key=lambda item: item.name.casefold())), tuple(wrong))


def _found(identifier: str, items: tuple[Preset | Finish, ...], noun: str) -> Preset | Finish:
    by_identifier = {item.identifier: item for item in items}
    if identifier not in by_identifier:
        remedy = close_names(str(identifier), by_identifier) or ": choose one of the list"
        raise PresetError(f"There is no {noun} {identifier!r}{remedy}")
    return by_identifier[identifier]
