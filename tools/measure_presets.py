# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the files of addon/presets from measured data: the same clones give the same files.

    git clone https://github.com/polyanskiy/refractiveindex.info-database
    git clone https://github.com/AntonPalmqvist/physically-based-api
    python -m tools.measure_presets refractiveindex.info-database physically-based-api

The committed files are from commit ff11b589 of the first and bcae8edc of the second. With --check
nothing is written, and the exit code says whether the files are what would be.
"""

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .preset_colour import CHANNELS
from .preset_database import PhysicallyBased, RefractiveIndex, SourceError, Spectrum
from .preset_dielectrics import CLEAR, COLOURED, TINTED
from .preset_finishes import FINISHES
from .preset_matte import MATTE
from .preset_matte_solver import facet_albedo
from .preset_metals import METALS
from .preset_optics import metal, transmittance

FOLDER = Path(__file__).resolve().parent.parent / "addon" / "presets"

D_LINE = 587.56  # nm, at which glass makers give the index n_d

_HEADER = "# SPDX-License-Identifier: GPL-3.0-or-later   (data: CC0, see source)\n"
_LICENCE = "CC0-1.0"
_PHYSICALLY_BASED = "https://api.physicallybased.info/v2/materials"
_METAL_NOTE = (
    f"n and k at {', '.join(map(str, CHANNELS))} nm; reflectance before it was limited to 0..1"
)
_GLASS_NOTE = "colour of light that went in and out"
_MATTE_NOTE = "of the whole surface; Color is that of its facets"
_KINDS = {"C": "CONDUCTOR", "D": "DIELECTRIC", "M": "DIFFUSE"}

Fields = dict[str, object]


def rows(table: str) -> Iterator[list[str]]:
    """Yield the cells of each line of a table."""
    for line in table.strip().splitlines():
        yield [cell.strip() for cell in line.split("|")]


def document(head: Fields, values: Fields, measured: Fields, source: Fields, note: str = "") -> str:
    """Return a TOML file; numbers have four decimals. `note` says what `measured` is."""
    parts = [_HEADER + _fields(head), "[values]\n" + _fields(values)]
    if measured:
        parts.append(f"[measured]  # {note}\n{_fields(measured)}")
    return "\n".join((*parts, "[source]\n" + _fields(source)))


def file_name(name: str) -> str:
    """Return a file's name for the name of a preset."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower()) + ".toml"


def conductors(database: RefractiveIndex) -> Iterator[tuple[str, str]]:
    """Yield path and text of each metal."""
    for name, page, description, tags in rows(METALS):
        spectrum = database.spectrum(page)
        found = metal(spectrum)
        values = {
            "BaseColor": found.base_color,
            "EdgeTint": found.edge_tint,
            "IOR": found.n,
            "Extinction": found.k,
        }
        measured = {"n": found.n_channel, "k": found.k_channel, "reflectance": found.reflectance}
        head = _head(name, description, tags)
        text = document(head, values, measured, _page(spectrum), _METAL_NOTE)
        yield f"conductor/{file_name(name)}", text


def dielectrics(database: RefractiveIndex, physical: PhysicallyBased) -> Iterator[tuple[str, str]]:
    """Yield path and text of each dielectric.

    IOR is that at the D line. A measured colour is that of light which went in and out, through two
    faces: Color, that of one face, is its square root.
    """
    for name, page, description, tags in rows(CLEAR):
        spectrum = database.spectrum(page)
        values = {"Color": np.ones(3), "IOR": _index(spectrum)}
        text = document(_head(name, description, tags), values, {}, _page(spectrum))
        yield f"dielectric/{file_name(name)}", text
    for name, page, description, tags, thickness in rows(TINTED):
        spectrum = database.spectrum(page)
        passed = transmittance(spectrum, float(thickness))
        values = {"Color": np.sqrt(passed), "IOR": _index(spectrum)}
        head = _head(name, f"{description}, {thickness} mm thick", tags)
        text = document(head, values, {"transmittance": passed}, _page(spectrum), _GLASS_NOTE)
        yield f"dielectric/{file_name(name)}", text
    for name, there, description, tags in rows(COLOURED):
        passed = physical.colour(there)
        values = {"Color": np.sqrt(passed), "IOR": float(physical.material(there)["ior"])}
        head = _head(name, description, tags)
        text = document(head, values, {"transmittance": passed}, _material(there), _GLASS_NOTE)
        yield f"dielectric/{file_name(name)}", text


def diffuse(physical: PhysicallyBased) -> Iterator[tuple[str, str]]:
    """Yield path and text of each matte material; the roughness is the source's."""
    for name, there, description, tags in rows(MATTE):
        albedo = physical.colour(there)
        roughness = float(physical.material(there)["roughness"])
        values = {"Color": facet_albedo(albedo, roughness), "Roughness": roughness}
        head = _head(name, description, tags)
        text = document(head, values, {"albedo": albedo}, _material(there), _MATTE_NOTE)
        yield f"diffuse/{file_name(name)}", text


def finishes() -> Iterator[tuple[str, str]]:
    """Yield path and text of each finish."""
    for name, kinds, roughness, anisotropy, rotation, distribution, description in rows(FINISHES):
        head = {
            "name": name,
            "description": description,
            "kinds": [_KINDS[letter] for letter in kinds.split()],
        }
        values = {
            "Roughness": float(roughness),
            "Anisotropy": float(anisotropy),
            "Rotation": float(rotation),
            "Distribution": distribution,
        }
        source = {"title": "Own choice", "url": "", "licence": _LICENCE}
        yield f"finish/{file_name(name)}", document(head, values, {}, source)


def files(database: RefractiveIndex, physical: PhysicallyBased) -> dict[str, str]:
    """Return the text of all files by their paths in FOLDER; raises SourceError."""
    made: dict[str, str] = {}
    for maker in (
        conductors(database),
        dielectrics(database, physical),
        diffuse(physical),
        finishes(),
    ):
        made.update(maker)
    return made


def differences(made: dict[str, str], folder: Path) -> list[str]:
    """Return, a line a file, what in `folder` is not as `made` has it."""
    there = {
        path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
        for path in folder.glob("*/*.toml")
    }
    lines = [f"{path} is missing" for path in sorted(made.keys() - there.keys())]
    lines += [f"{path} is not of the tables" for path in sorted(there.keys() - made.keys())]
    lines += [
        f"{path} differs"
        for path in sorted(made.keys() & there.keys())
        if made[path] != there[path]
    ]
    return lines


def write(made: dict[str, str], folder: Path) -> None:
    """Make `folder` hold just the files `made`."""
    for path in folder.glob("*/*.toml"):
        if path.relative_to(folder).as_posix() not in made:
            path.unlink()
    for name, text in made.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")


def main() -> int:
    """Write the files, or check them, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("refractiveindex", type=Path, help="clone of refractiveindex.info-database")
    parser.add_argument("physicallybased", type=Path, help="clone of physically-based-api")
    parser.add_argument("--check", action="store_true", help="only say what would change")
    arguments = parser.parse_args()
    try:
        made = files(
            RefractiveIndex(arguments.refractiveindex), PhysicallyBased(arguments.physicallybased)
        )
    except SourceError as error:
        print(f"No preset was made: {error}", file=sys.stderr)
        return 1
    changes = differences(made, FOLDER)
    print("\n".join([*changes, f"{len(made)} presets and finishes, {len(changes)} changed"]))
    if arguments.check:
        return 1 if changes else 0
    write(made, FOLDER)
    return 0


def _head(name: str, description: str, tags: str) -> Fields:
    return {"name": name, "description": description, "tags": tags.split(", ")}


def _page(spectrum: Spectrum) -> Fields:
    return {"title": spectrum.title, "url": spectrum.url, "licence": _LICENCE}


def _material(name: str) -> Fields:
    title = f"physicallybased.info: {name}"
    return {"title": title, "url": _PHYSICALLY_BASED, "licence": _LICENCE}


def _index(spectrum: Spectrum) -> float:
    return float(spectrum.n(np.array([D_LINE]))[0])


def _fields(fields: Fields) -> str:
    return "".join(f"{key} = {_toml(value)}\n" for key, value in fields.items())


def _toml(value: object) -> str:
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, float):
        return str(round(float(value), 4) + 0.0)
    return "[" + ", ".join(_toml(item) for item in value) + "]"


if __name__ == "__main__":
    sys.exit(main())
