# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads compiled shaders (.oso text): the parameter list, and whether two are the same program.

Cycles' own way needs the `oslquery` module, which not every Blender can import.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from .parameter import Parameter

_OSL_TYPES = {
    "COLOR": ("color",),
    "FLOAT": ("float",),
    "INT": ("int",),
    "VECTOR": ("vector",),
    "NORMAL": ("normal",),
    "TANGENT": ("vector", "normal"),
}

# What the compiler tells about a line: source lines, metadata, where a symbol is read and written.
_HINT = re.compile(r"\s%\w+(\{[^}]*\})?")
_SYMBOLS = ("local", "temp", "const", "global")


@dataclass(frozen=True)
class OsoParameter:
    """A parameter as the compiled shader declares it.

    `default` holds one or three numbers, or none for a closure. `computed` is True if the
    default is an expression, such as the shading normal, and `default` says nothing.
    """

    name: str
    type: str
    default: tuple[float, ...]
    computed: bool
    output: bool


def oso_parameters(bytecode: str) -> tuple[OsoParameter, ...]:
    """Return the shader's parameters and outputs in the order of their declaration.

    Raises ValueError if the text is no compiled shader.
    """
    if not bytecode.startswith("OpenShadingLanguage"):
        raise ValueError(f"not a compiled shader: it starts with {bytecode[:20]!r}")
    found = []
    for line in bytecode.splitlines():
        words = line.split()
        if not words or words[0] not in ("param", "oparam"):
            continue
        output = words[0] == "oparam"
        closure = words[1] == "closure"
        type_name = "closure color" if closure else words[1]
        name, rest = (words[3], words[4:]) if closure else (words[2], words[3:])
        numbers = []
        for word in rest:
            if word.startswith(("%", '"')):
                break
            numbers.append(float(word))
        found.append(OsoParameter(name, type_name, tuple(numbers), "%initexpr" in rest, output))
    return tuple(found)


def check_against(parameters: tuple[Parameter, ...], bytecode: str) -> None:
    """Raise ValueError unless the shader declares exactly `parameters`: names, order and types."""
    declared = [(p.name, p.type) for p in oso_parameters(bytecode) if not p.output]
    names = [name for name, _ in declared]
    wanted = [p.identifier for p in parameters]
    if names != wanted:
        raise ValueError(
            f"The shader declares {', '.join(names)}; the extension expects {', '.join(wanted)}. "
            "Reinstall the extension"
        )
    for (name, type_name), parameter in zip(declared, parameters, strict=True):
        if type_name not in _OSL_TYPES[parameter.type]:
            raise ValueError(
                f"The shader declares {name} as {type_name}; the extension expects "
                f"{' or '.join(_OSL_TYPES[parameter.type])}. Reinstall the extension"
            )


def same_program(first: str, second: str) -> bool:
    """Return whether two compiled shaders have the same interface and do the same, step by step.

    Comments, metadata, source lines and the names of variables do not count: compilers of
    different versions number them differently.
    """
    return first == second or list(_program(first)) == list(_program(second))


def _program(bytecode: str) -> Iterator[list[str]]:
    """Yield the program's lines in words, variables numbered in the order of their first use.

    Before that first use stands the declaration without the name: type, and value of a constant.
    """
    declared: dict[str, str] = {}
    numbers: dict[str, str] = {}
    for line in bytecode.splitlines():
        words = _HINT.sub("", line).split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] in _SYMBOLS:
            place = 3 if words[1] == "closure" else 2
            name = words.pop(place)
            declared[name] = " ".join(words)
            continue
        for word in words:
            if word in declared and word not in numbers:
                numbers[word] = f"${len(numbers)}"
                yield [numbers[word], declared[word]]
        yield [numbers.get(word, word) for word in words]
