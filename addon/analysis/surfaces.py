# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds our nodes in the materials of a scene, and reads them as surfaces."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import bpy

from ..core.analysis.prediction import MOST_BOUNCES, QUALITIES, Choice, Surface
from ..core.analysis.reflectance import mean_of_index, mean_of_tint
from ..core.intervals import Interval, clamped, hull
from ..core.kinds import Kind, kind_named
from ..core.parameter import Parameter
from ..material.graph import Path, node_kind, reached_nodes, surface_tree
from ..scene.ranges import Range, input_range
from ..scene.sources import ANIMATED, Sources


@dataclass
class Found:
    """One of our nodes, and how it is reached.

    tree      -- the node tree that holds it: a material's, or a group's that several may use
    materials -- the materials that show it
    paths     -- for each way to it, the group nodes from the outermost to the innermost
    """

    tree: bpy.types.NodeTree
    node: bpy.types.ShaderNodeGroup
    materials: list[bpy.types.Material] = field(default_factory=list)
    paths: list[Path] = field(default_factory=list)

    @property
    def kind(self) -> Kind:
        """What it is made of."""
        return kind_named(node_kind(self.node))

    @property
    def is_shared(self) -> bool:
        """Whether it lies in a node group, not in a material's own nodes."""
        return bool(self.paths[0])

    @property
    def key(self) -> tuple[str, str, str]:
        """A key that finds it again in the file. No two nodes share one."""
        owner = self.tree if self.is_shared else self.materials[0]
        return ("group" if self.is_shared else "material", owner.name_full, self.node.name)

    @property
    def name(self) -> str:
        """The material's name, and the node's if it has one of its own."""
        names = ", ".join(material.name for material in self.materials)
        return names if self.node.name == self.kind.name else f"{names}: {self.node.name}"


def found_nodes(materials: Iterable[bpy.types.Material]) -> list[Found]:
    """Return our nodes that reach the outputs of these materials, each node once."""
    found: dict[tuple[int, str], Found] = {}
    for material in materials:
        for path, node in reached_nodes(surface_tree(material)):
            if node.mute or not node_kind(node):
                continue
            tree = path[-1].node_tree if path else material.node_tree
            key = (tree.as_pointer(), node.name)
            one = found.setdefault(key, Found(tree, node))
            if material not in one.materials:
                one.materials.append(material)
            one.paths.append(path)
    return list(found.values())


def read_surface(found: Found, sources: Sources | None = None) -> tuple[Surface, tuple[str, ...]]:
    """Return the surface with the ranges of its inputs, and notes on what is unknown."""
    sources = sources or Sources()
    notes: list[str] = []
    kind = found.kind

    def read(identifier: str) -> Range:
        return _legal_range(found, kind.by_identifier[identifier], sources, notes)

    def number(identifier: str) -> Interval:
        return read(identifier)[0]

    surface = Surface(
        kind=kind.identifier,
        roughness=number("Roughness"),
        anisotropy=number("Anisotropy"),
        distributions=_whole(number("Distribution")),
        models=_whole(number("Model")),
        colour=_brightest(kind, read),
        ior=number("IOR") if kind.identifier == "DIELECTRIC" else (1.5, 1.5),
        tolerance=number("Tolerance")[1],
        walks=round(number("Walks")[1]),
    )
    return surface, tuple(notes)


def read_choice(found: Found) -> Choice:
    """Return the values on the node. For linked inputs that is the value without the link."""
    quality = _set_value(found, "Quality", len(QUALITIES) - 1)
    return Choice(QUALITIES[quality], max(_set_value(found, "MaxBounces", MOST_BOUNCES), 1))


def why_fixed(found: Found, sources: Sources | None = None) -> str:
    """Return why nothing can be proposed for the node or set on it; "" if it can."""
    sources = sources or Sources()
    owners = (found.tree, *(() if found.is_shared else found.materials))
    if any(owner.library for owner in owners):
        return "It is linked from a library"
    if any(owner.override_library for owner in owners):
        return "It is a library override"
    for identifier in ("Quality", "MaxBounces"):
        label = found.kind.by_identifier[identifier].label
        socket = found.node.inputs.get(label)
        if socket is None:
            return f"Its node group is of another version and has no {label}"
        if socket.is_linked:
            return f"{label} is linked"
        if sources.animates(socket):
            return f"{label} has a driver or is animated"
    only = found.kind.by_identifier["BounceOnly"]
    if _legal_range(found, only, sources, [])[0] != (0.0, 0.0):
        return f"{only.label} shows one bounce, for study"
    return ""


def apply_choice(found: Found, choice: Choice) -> None:
    """Set the node's Quality and Max Bounces."""
    by_identifier = found.kind.by_identifier
    quality, bounces = by_identifier["Quality"], by_identifier["MaxBounces"]
    found.node.inputs[quality.label].default_value = quality.checked(choice.quality)
    found.node.inputs[bounces.label].default_value = bounces.checked(choice.max_bounces)


def _legal_range(found: Found, parameter: Parameter, sources: Sources, notes: list[str]) -> Range:
    """Return the legal range of an input over all ways to the node."""
    socket = found.node.inputs.get(parameter.label)
    if socket is None:
        value = parameter.default
        return tuple((v, v) for v in (value if parameter.is_vector else (value,)))
    sources.causes.clear()
    ways = [input_range(socket, path, sources) for path in found.paths]
    legal = tuple(clamped(hull(parts), *parameter.legal) for parts in zip(*ways, strict=True))
    unknown = any(not math.isfinite(end) for way in ways for part in way for end in part)
    if unknown or ANIMATED in sources.causes:
        notes.append(_note(parameter, hull(legal), sources.causes))
    return legal


def _note(parameter: Parameter, taken: Interval, causes: list[str]) -> str:
    state = ANIMATED if ANIMATED in causes else "unknown"
    text = f"{parameter.label} is {state}, taken as {taken[0]:g} to {taken[1]:g}"
    others = [cause for cause in dict.fromkeys(causes) if cause != ANIMATED]
    return f"{text}: {', '.join(others)}" if others else text


def _brightest(kind: Kind, read: Callable[[str], Range]) -> tuple[float, float, float]:
    """Return the largest part of light that is left after a bounce."""
    if kind.identifier != "CONDUCTOR":
        return tuple(high for _, high in read("Color"))
    fresnel = _whole(read("Fresnel")[0])
    found = []
    if 0 in fresnel:
        colours = [tuple(high for _, high in read(name)) for name in ("BaseColor", "EdgeTint")]
        found.append(mean_of_tint(*colours))
    if 1 in fresnel:
        n, k = read("IOR"), read("Extinction")
        if all(low == high for low, high in (*n, *k)):
            found.append(mean_of_index([low for low, _ in n], [low for low, _ in k]))
        else:
            found.append((1.0, 1.0, 1.0))
    return tuple(map(max, zip(*found, strict=True)))


def _whole(interval: Interval) -> tuple[int, ...]:
    return tuple(range(math.floor(interval[0]), math.ceil(interval[1]) + 1))


def _set_value(found: Found, identifier: str, highest: int) -> int:
    parameter = found.kind.by_identifier[identifier]
    socket = found.node.inputs.get(parameter.label)
    value = parameter.default if socket is None else socket.default_value
    return min(max(int(value), 0), highest)
