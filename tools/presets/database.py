# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the sources of the presets: clones of the refractiveindex.info database and of
physicallybased.info's repository. Both are CC0.
"""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from urllib.parse import urlencode

import numpy as np

# Measurements may stop here, in nm. The eye sees little beyond, so the outermost values are used.
LOWEST, HIGHEST = 410.0, 700.0

_ENTRY = re.compile(r'\s*(?:- )?(SHELF|BOOK|PAGE|name|data): "?(.*?)"?\s*$')
_MARKUP = re.compile(r"<[^>]*>")
_RANGE = re.compile(r"[:;] (?:n|k|n,k|n\(\w\)|n,k\(\w\))[ ,;].*$")


class SourceError(ValueError):
    """Data is missing or cannot be read. The message names the place and the remedy."""


@dataclass(frozen=True)
class Spectrum:
    """A page of the database: `n` and `k` return indices at wavelengths in nm.

    `title` is the page's name without its range of wavelengths, `url` its address. `k` is None if
    the page has none. Outside the measured range, a table gives its outermost value and a formula
    raises SourceError.
    """

    title: str
    url: str
    n: Callable[[np.ndarray], np.ndarray]
    k: Callable[[np.ndarray], np.ndarray] | None


@dataclass(frozen=True)
class RefractiveIndex:
    """A clone of github.com/polyanskiy/refractiveindex.info-database in `folder`."""

    folder: Path

    @cached_property
    def pages(self) -> dict[str, tuple[str, str]]:
        """Title (book: page) and data file of each page, by "shelf/book/page"."""
        catalogue = self.folder / "database" / "catalog-nk.yml"
        if not catalogue.is_file():
            raise SourceError(f"{catalogue} is missing: give a clone of the database")
        found, place, names, level = {}, {}, {}, ""
        for line in catalogue.read_text(encoding="utf-8").splitlines():
            match = _ENTRY.match(line)
            if not match:
                continue
            key, value = match.groups()
            if key == "name":
                names[level] = _RANGE.sub("", _MARKUP.sub("", value))
            elif key == "data":
                page = "/".join(place[part] for part in ("SHELF", "BOOK", "PAGE"))
                found[page] = (f"{names['BOOK']}: {names['PAGE']}", value)
            else:
                level, place[key] = key, value
        return found

    def spectrum(self, page: str) -> Spectrum:
        """Return the spectrum of "shelf/book/page"; raises SourceError if there is none."""
        if page not in self.pages:
            raise SourceError(f"{page} is not in the catalogue: correct the table of presets")
        title, file = self.pages[page]
        path = self.folder / "database" / "data" / file
        shelf, book, name = page.split("/")
        parts = {"shelf": shelf, "book": book, "page": name}
        url = f"https://refractiveindex.info/?{urlencode(parts)}"
        functions = {}
        for block in _blocks(path):
            functions.update(_functions(path, block))
        if "n" not in functions:
            raise SourceError(f"{path} has no n: choose another page")
        return Spectrum(title, url, functions["n"], functions.get("k"))


@dataclass(frozen=True)
class PhysicallyBased:
    """A clone of github.com/AntonPalmqvist/physically-based-api in `folder`."""

    folder: Path

    @cached_property
    def materials(self) -> dict[str, dict]:
        """The entry of each material by name."""
        path = self.folder / "deploy" / "v2" / "materials.json"
        if not path.is_file():
            raise SourceError(f"{path} is missing: give a clone of physically-based-api")
        data = json.loads(path.read_text(encoding="utf-8"))["data"]
        return {material["name"]: material for material in data}

    def material(self, name: str) -> dict:
        """Return the material called `name`; raises SourceError if there is none."""
        if name not in self.materials:
            raise SourceError(f"physicallybased.info has no {name!r}: correct the table of presets")
        return self.materials[name]

    def colour(self, name: str) -> np.ndarray:
        """Return its linear Rec. 709 colour, shape (3)."""
        colours = self.material(name)["color"]
        linear = next(c["color"] for c in colours if c["colorSpace"] == "srgb-linear")
        return np.array(linear, dtype=float)


def _blocks(path: Path) -> list[dict[str, list[str]]]:
    """The blocks of the section DATA: the lines of each entry by its key."""
    if not path.is_file():
        raise SourceError(f"{path} is missing: give a complete clone of the database")
    blocks, inside, key = [], False, ""
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith((" ", "-")):
            inside = line.startswith("DATA:")
            continue
        if not inside:
            continue
        entry = re.match(r"\s*(- )?(\w+):(.*)$", line)
        if entry:
            if entry[1]:
                blocks.append({})
            key = entry[2]
            blocks[-1][key] = [entry[3].strip()]
        else:
            blocks[-1][key].append(line.strip())
    return blocks


def _functions(path: Path, block: dict[str, list[str]]) -> dict[str, Callable]:
    kind = block["type"][0]
    if kind.startswith("tabulated"):
        rows = np.array([[float(word) for word in row.split()] for row in block["data"][1:] if row])
        columns = kind.removeprefix("tabulated ")
        return {
            name: _table(path, rows[:, 0] * 1e3, rows[:, 1 + column])
            for column, name in enumerate(columns)
        }
    if kind not in _FORMULAS:
        raise SourceError(f"{path} has a {kind}, which is not known here: choose another page")
    limits = [1e3 * float(word) for word in block["wavelength_range"][0].split()]
    coefficients = [float(word) for word in block["coefficients"][0].split()]

    def formula(wavelengths: np.ndarray) -> np.ndarray:
        wavelengths = np.asarray(wavelengths, dtype=float)
        if wavelengths.min() < limits[0] or wavelengths.max() > limits[1]:
            raise SourceError(f"{path} goes from {limits[0]:g} to {limits[1]:g} nm only")
        return _FORMULAS[kind](wavelengths / 1e3, coefficients)

    return {"n": formula}


def _table(path: Path, at: np.ndarray, values: np.ndarray) -> Callable:
    def interpolated(wavelengths: np.ndarray) -> np.ndarray:
        wavelengths = np.asarray(wavelengths, dtype=float)
        needed = np.clip(wavelengths, LOWEST, HIGHEST)
        if at[0] > needed.min() or at[-1] < needed.max():
            raise SourceError(f"{path} goes from {at[0]:g} to {at[-1]:g} nm only")
        return np.interp(wavelengths, at, values)

    return interpolated


# The dispersion formulas, numbered as in the database's documentation. x is in um.


def _sellmeier(x: np.ndarray, c: list[float], power: int) -> np.ndarray:
    terms = (a * x**2 / (x**2 - b**power) for a, b in zip(c[1::2], c[2::2], strict=True))
    return np.sqrt(1.0 + c[0] + sum(terms))


def _general(x: np.ndarray, c: list[float]) -> np.ndarray:
    square = c[0] + _polynomial(x, c[9:])
    for a, power, b, exponent in (term for term in (c[1:5], c[5:9]) if any(term)):
        square = square + a * x**power / (x**2 - b**exponent)
    return np.sqrt(square)


def _polynomial(x: np.ndarray, c: list[float]) -> np.ndarray:
    return sum(a * x**b for a, b in zip(c[::2], c[1::2], strict=True))


_FORMULAS = {
    "formula 1": lambda x, c: _sellmeier(x, c, 2),
    "formula 2": lambda x, c: _sellmeier(x, c, 1),
    "formula 3": lambda x, c: np.sqrt(c[0] + _polynomial(x, c[1:])),
    "formula 4": _general,
    "formula 5": lambda x, c: c[0] + _polynomial(x, c[1:]),
}
