# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the OSL sources and joins each with its headers into one self-contained text."""

import re
from pathlib import Path

_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')

# Cycles puts these in front of every shader by itself.
_BUILT_IN = frozenset({"stdosl.h", "stdcycles.h"})


class ShaderSourceError(RuntimeError):
    """A shader source is missing or unreadable; the message names the file and the remedy."""


def shader_directory() -> Path:
    """Return the folder of the .osl files.

    Inside the installed extension it lies in the package; in the repository, beside it.
    Raises ShaderSourceError if neither exists.
    """
    package = Path(__file__).resolve().parent.parent
    for folder in (package / "osl", package.parent / "osl"):
        if folder.is_dir():
            return folder
    raise ShaderSourceError(
        f"The shader folder {package / 'osl'} is missing. Reinstall the extension"
    )


def inlined_source(name: str, directory: Path | None = None) -> str:
    """Return the text of shader `name` ("microbounce_conductor") with its headers put in place.

    Each header is taken once, at its first `#include "..."`, relative to the including file and
    then to `directory` (default: shader_directory()). Raises ShaderSourceError if a file is
    missing or cannot be read.
    """
    directory = shader_directory() if directory is None else directory
    path = directory / f"{name}.osl"
    lines = _inlined_lines(path, directory, {path.resolve()}, included_by=None)
    return "\n".join(lines) + "\n"


def _inlined_lines(
    path: Path, directory: Path, seen: set[Path], included_by: Path | None
) -> list[str]:
    lines: list[str] = []
    for line in _read(path, included_by).splitlines():
        match = _INCLUDE.match(line)
        if not match or match.group(1) in _BUILT_IN:
            lines.append(line)
            continue
        beside = path.parent / match.group(1)
        header = beside if beside.is_file() else directory / match.group(1)
        if header.resolve() in seen:
            continue
        seen.add(header.resolve())
        lines += _inlined_lines(header, directory, seen, included_by=path)
    return lines


def _read(path: Path, included_by: Path | None) -> str:
    wanted_by = f", included by {included_by.name}," if included_by else ""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise ShaderSourceError(
            f"The shader file {path}{wanted_by} is missing. Reinstall the extension"
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise ShaderSourceError(
            f"The shader file {path}{wanted_by} cannot be read ({error}). "
            "Check its permissions or reinstall the extension"
        ) from error
