# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and validates preset files: from TOML text to checked values."""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from types import MappingProxyType

from ..kinds import KINDS, kind_named
from ..parameter import Value

# Folders of preset files: one a kind of material, and one of finishes.
FINISH = "finish"
KIND_OF_FOLDER = {kind.lower(): kind for kind in KINDS}
FOLDERS = (*KIND_OF_FOLDER, FINISH)

_TEXTS = ("name", "description")


class PresetError(ValueError):
    """A preset that is missing or cannot be used; says which, what is wrong and what to do."""


@dataclass(frozen=True)
class Source:
    """Where values come from: `title` and `url` ("" for a choice of our own), and its `licence`."""

    title: str
    url: str
    licence: str


@dataclass(frozen=True)
class Preset:
    """A material: `values` are checked values by the identifiers of its kind's parameters."""

    identifier: str
    kind: str
    name: str
    description: str
    tags: tuple[str, ...]
    values: Mapping[str, Value]
    source: Source


@dataclass(frozen=True)
class Finish:
    """What was done to a surface: values that every kind in `kinds` has."""

    identifier: str
    name: str
    description: str
    kinds: tuple[str, ...]
    values: Mapping[str, Value]
    source: Source


def read(path: Path) -> Preset | Finish:
    """Read one file; its folder says of which kind it is. Raises PresetError."""
    import tomllib

    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        return _made(path, table)
    except UnicodeDecodeError as error:
        raise _error(path, f"is not UTF-8 ({error})", "save it as UTF-8") from error
    except OSError as error:
        raise _error(path, f"cannot be read ({error})", "install the extension again") from error
    except tomllib.TOMLDecodeError as error:
        raise _error(path, f"is not TOML ({error})", "correct that line") from error
    except (TypeError, ValueError) as error:
        raise _error(path, str(error), "correct the file or delete it") from error


def _made(path: Path, table: dict[str, object]) -> Preset | Finish:
    folder = path.parent.name
    identifier = f"{folder}/{path.stem}"
    texts = [_text(table, key) for key in _TEXTS]
    if folder == FINISH:
        kinds = _words(table, "kinds")
        if not kinds:
            raise ValueError("kinds is empty")
        values = [_values(table, kind) for kind in kinds]
        return Finish(identifier, *texts, kinds, values[0], _source(table))
    if folder not in KIND_OF_FOLDER:
        raise ValueError(f"the folder {folder!r} is not one of {', '.join(FOLDERS)}")
    kind = KIND_OF_FOLDER[folder]
    tags, values = _words(table, "tags"), _values(table, kind)
    return Preset(identifier, kind, *texts, tags, values, _source(table))


def _values(table: dict[str, object], kind: str) -> Mapping[str, Value]:
    parameters = kind_named(kind).by_identifier
    values = {}
    for identifier, value in _table(table, "values").items():
        if identifier not in parameters:
            raise ValueError(f"{kind} has no {identifier!r}{close_names(identifier, parameters)}")
        parts = value if isinstance(value, list) else [value]
        if any(isinstance(part, bool) for part in parts):  # which Python takes for numbers
            raise TypeError(f"{identifier} has true or false in it: give numbers")
        values[identifier] = parameters[identifier].checked(value)
    if not values:
        raise ValueError("[values] is empty")
    return MappingProxyType(values)


def _source(table: dict[str, object]) -> Source:
    source = _table(table, "source")
    return Source(*(_text(source, key) for key in ("title", "url", "licence")))


def _text(table: dict[str, object], key: str) -> str:
    text = table.get(key)
    if not isinstance(text, str) or "\n" in text or (not text.strip() and key != "url"):
        raise TypeError(f"{key} is {text!r} and not a line of text")
    return text


def _words(table: dict[str, object], key: str) -> tuple[str, ...]:
    words = table.get(key)
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise TypeError(f"{key} is {words!r} and not a list of texts")
    return tuple(words)


def _table(table: dict[str, object], key: str) -> dict[str, object]:
    inner = table.get(key)
    if not isinstance(inner, dict):
        raise TypeError(f"the table [{key}] is missing")
    return inner


def close_names(word: str, words: Mapping[str, object]) -> str:
    """Return a hint at names like `word`, "" if there are none."""
    close = get_close_matches(word, words)
    return f" (did you mean {' or '.join(close)}?)" if close else ""


def _error(path: Path, wrong: str, remedy: str) -> PresetError:
    return PresetError(f"{path}: {wrong}. To mend it, {remedy}.")
