# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets that users save: files of the same form as the extension's own, only ever parsed."""

import struct
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ..kinds import kind_named
from ..parameter import Parameter, Value
from .files import Finish, Preset, PresetError, read

SUFFIX = ".toml"
_OWN = "user/"  # before the identifier: one of the extension's own may have the same name

# These belong to one surface and are not saved: zero means "the surface's own".
_SURFACES_OWN = ("NORMAL", "TANGENT")
_LARGEST = 65_536  # bytes; what is saved here takes about one thousand


def saved_parameters(kind: str) -> tuple[Parameter, ...]:
    """Return the parameters of a kind that a user's preset holds."""
    parameters = kind_named(kind).parameters
    return tuple(p for p in parameters if p.type not in _SURFACES_OWN)


def preset_text(kind: str, name: str, values: Mapping[str, object]) -> str:
    """Return the content of a file with these values by parameter identifier.

    Numbers are rounded to the shortest that is the same in single precision, as sockets hold it.
    Raises PresetError for an empty or unprintable name and for no values, and what
    Parameter.checked() raises for a bad one.
    """
    import json

    if not name.strip() or not name.isprintable():
        raise PresetError(f"The preset's name is {name!r}: give one of letters and digits")
    if not values:
        raise PresetError("There are no values to save, since all are linked: unlink some")
    known = kind_named(kind).by_identifier
    lines = [
        f"{identifier} = {_toml(known[identifier].checked(_rounded(value)))}"
        for identifier, value in values.items()
    ]
    return "\n".join(
        [
            f"name = {json.dumps(name.strip(), ensure_ascii=False)}",
            'description = "Saved by a user"',
            "tags = []",
            "",
            "[values]",
            *lines,
            "",
            "[source]",
            'title = "Own values"',
            'url = ""',
            'licence = "Own"',
            "",
        ]
    )


def load(path: Path) -> Preset:
    """Read a user's preset; its folder says of which kind it is. Nothing in it is executed.

    Raises PresetError for a file that is missing, damaged, too large or of another sort.
    """
    if path.exists() and not path.is_file():  # of a device there is no end
        raise PresetError(f"{path}: is no file and no preset. Choose one of the saved presets")
    try:
        size = path.stat().st_size
        if size > _LARGEST:
            raise PresetError(f"{path}: is {size} bytes long and no preset. Delete it")
        found = read(path)
    except OSError as error:
        raise PresetError(f"{path}: cannot be read ({error}). Save the preset again") from error
    except RecursionError as error:
        raise PresetError(f"{path}: is nested too deeply and no preset. Delete it") from error
    if isinstance(found, Finish):
        raise PresetError(f"{path}: is a finish and not a preset. Apply it as a finish")
    return replace(found, identifier=f"{_OWN}{found.identifier}")


def is_users(item: Preset | Finish) -> bool:
    """Return whether a user saved it."""
    return item.identifier.startswith(_OWN)


def _rounded(value: object) -> object:
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return _shortest(value)
    return tuple(_shortest(component) for component in value)


def _shortest(number: float) -> float:
    """Return the number of fewest digits that single precision does not tell from this one."""
    single = struct.pack("f", number)
    candidates = (float(f"{number:.{digits}g}") for digits in range(1, 10))
    return next((c for c in candidates if struct.pack("f", c) == single), number)


def _toml(value: Value) -> str:
    return f"[{', '.join(map(repr, value))}]" if isinstance(value, tuple) else repr(value)
