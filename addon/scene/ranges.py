# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the values that a node's input can take at any frame, through links to values, textures and
maths.

A range is a tuple of intervals, one for a number and three for a colour or vector. A node that is
not understood can give any value; the caller limits it to the legal ones.
"""

from dataclasses import dataclass
from functools import partial

import bpy

from ..core.intervals import ANYTHING, OPERATIONS, Interval, clamped, corners, hull, mapped, mixed
from ..material.graph import Path, input_behind, linked_output, passes_on, socket_named
from .sources import Sources

Range = tuple[Interval, ...]

_UNKNOWN: Range = (ANYTHING,)
_LUMINANCE = (0.2126, 0.7152, 0.0722)
_DEEPEST = 64  # links; longer chains are rings of nodes
_RAMP_SAMPLES = 64


def input_range(
    socket: bpy.types.NodeSocket, path: Path, sources: Sources, depth: int = 0
) -> Range:
    """Return the range of an input socket; `path` has the groups that lead to its tree."""
    source = linked_output(socket)
    if source is None:
        return _set_value(socket, sources)
    return _converted(_output_range(source, path, sources, depth + 1), source, socket)


def _set_value(socket: bpy.types.NodeSocket, sources: Sources) -> Range:
    value = getattr(socket, "default_value", None)
    if value is None or isinstance(value, str):
        return _UNKNOWN
    parts = tuple(value)[:3] if hasattr(value, "__len__") else (value,)
    return sources.over_time(socket, tuple((float(part), float(part)) for part in parts))


def _converted(found: Range, source: bpy.types.NodeSocket, target: bpy.types.NodeSocket) -> Range:
    """Convert as Blender does between numbers and colours or vectors."""
    wide = target.type in ("RGBA", "VECTOR")
    if wide:
        return found if len(found) == 3 else found * 3
    if len(found) == 1:
        return found
    weights = _LUMINANCE if source.type == "RGBA" else (1.0 / 3.0,) * 3
    return (
        tuple(sum(w * part[end] for w, part in zip(weights, found, strict=True)) for end in (0, 1)),
    )


def _output_range(socket: bpy.types.NodeSocket, path: Path, sources: Sources, depth: int) -> Range:
    node = socket.node
    if depth > _DEEPEST or sources.animates_settings(node):
        return _UNKNOWN
    if passes_on(node):
        behind = input_behind(socket, path)
        return input_range(*behind, sources, depth) if behind is not None else _UNKNOWN
    reader = _READERS.get(node.bl_idname)
    if reader is None:
        return _UNKNOWN
    return reader(node, socket, _Read(path, sources, depth))


@dataclass(frozen=True)
class _Read:
    """Gives the range of an input of the node that is read."""

    path: Path
    sources: Sources
    depth: int

    def __call__(self, socket: bpy.types.NodeSocket) -> Range:
        return input_range(socket, self.path, self.sources, self.depth)


# Each function below reads one kind of node: (node, its output, reader of an input).


def _value(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    return _set_value(socket, read.sources)


def _image(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    found = read.sources.image(node.image)
    if found is None:
        return _UNKNOWN
    if node.extension == "CLIP":
        found = tuple(hull((part, (0.0, 0.0))) for part in found)
    return found[:3] if socket.name == "Color" else found[3:]


def _math(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    operation = OPERATIONS.get(node.operation)
    if operation is None:
        return _limited(_UNKNOWN, node.use_clamp)
    return _limited((operation(*(read(one)[0] for one in node.inputs)),), node.use_clamp)


def _limited(found: Range, clamp: bool) -> Range:
    return tuple(map(clamped, found)) if clamp else found


def _map_range(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    if node.data_type != "FLOAT":
        return (ANYTHING,) * 3
    names = ("From Min", "From Max", "To Min", "To Max")
    ends = [read(node.inputs[name])[0] for name in names]
    low, high = ends[2:]
    smooth = node.interpolation_type in ("SMOOTHSTEP", "SMOOTHERSTEP")
    constant = all(end[0] == end[1] for end in ends)
    if constant and node.interpolation_type == "LINEAR":
        source, target = (ends[0][0], ends[1][0]), (low[0], high[0])
        return (mapped(read(node.inputs["Value"])[0], source, target, node.clamp),)
    return (hull((low, high)),) if smooth or node.clamp else _UNKNOWN


def _clamp(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    value, low, high = (read(one)[0] for one in node.inputs)
    if node.clamp_type == "RANGE":
        low, high = hull((low, high)), hull((low, high))
    return (tuple(min(max(value[end], low[end]), max(high[end], low[end])) for end in (0, 1)),)


def _ramp(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    low, high = clamped(read(node.inputs[0])[0])
    ramp = node.color_ramp
    places = [low + (high - low) * i / _RAMP_SAMPLES for i in range(_RAMP_SAMPLES + 1)]
    places += [e.position for e in ramp.elements if low <= e.position <= high]
    # A constant ramp jumps, so the value just before an element counts too.
    places += [e.position - 1e-5 for e in ramp.elements if low < e.position <= high]
    colours = [ramp.evaluate(place) for place in places]
    found = tuple((min(c[i] for c in colours), max(c[i] for c in colours)) for i in range(4))
    return found[:3] if socket.name == "Color" else found[3:]


def _invert(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    (factor,), colour = read(node.inputs[0]), read(node.inputs[1])
    return tuple(mixed(factor, part, (1.0 - part[1], 1.0 - part[0])) for part in colour)


def _gamma(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    colour, (gamma,) = read(node.inputs[0]), read(node.inputs[1])
    return tuple(OPERATIONS["POWER"](part, gamma, None) for part in colour)


def _mix(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    kind = {"FLOAT": "Float", "RGBA": "Color"}.get(node.data_type)
    if kind is None or (kind == "Color" and node.blend_type not in _BLENDS):
        return _limited((ANYTHING,) * 3, kind == "Color" and node.clamp_result)
    names = ("Factor_Float", f"A_{kind}", f"B_{kind}")
    (factor,), a, b = (read(socket_named(node.inputs, name)) for name in names)
    if node.clamp_factor:
        factor = clamped(factor)
    blend = _BLENDS[node.blend_type] if kind == "Color" else mixed
    found = tuple(blend(factor, *parts) for parts in zip(a, b, strict=True))
    return _limited(found, kind == "Color" and node.clamp_result)


def _blended_product(factor: Interval, a: Interval, b: Interval) -> Interval:
    return corners(lambda f, x, y: x * (1.0 - f + f * y), factor, a, b)


def _blended_sum(factor: Interval, a: Interval, b: Interval) -> Interval:
    return corners(lambda f, x, y: x + f * y, factor, a, b)


_BLENDS = {"MIX": mixed, "MULTIPLY": _blended_product, "ADD": _blended_sum}


def _separate(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    if getattr(node, "mode", "RGB") != "RGB":
        return _UNKNOWN
    return (read(node.inputs[0])[list(node.outputs).index(socket)],)


def _combine(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    if getattr(node, "mode", "RGB") != "RGB":
        return (ANYTHING,) * 3
    return tuple(read(one)[0] for one in node.inputs)


def _grey(node: bpy.types.Node, socket: bpy.types.NodeSocket, read: _Read) -> Range:
    return _converted(read(node.inputs[0]), node.inputs[0], socket)


def _within(low: float, high: float, *_: object) -> Range:
    return ((low, high),)


_READERS = {
    "ShaderNodeValue": _value,
    "ShaderNodeRGB": _value,
    "ShaderNodeTexImage": _image,
    "ShaderNodeMath": _math,
    "ShaderNodeMapRange": _map_range,
    "ShaderNodeClamp": _clamp,
    "ShaderNodeValToRGB": _ramp,
    "ShaderNodeInvert": _invert,
    "ShaderNodeGamma": _gamma,
    "ShaderNodeMix": _mix,
    "ShaderNodeSeparateColor": _separate,
    "ShaderNodeSeparateXYZ": _separate,
    "ShaderNodeCombineColor": _combine,
    "ShaderNodeCombineXYZ": _combine,
    "ShaderNodeRGBToBW": _grey,
    "ShaderNodeFresnel": partial(_within, 0.0, 1.0),
    "ShaderNodeLayerWeight": partial(_within, 0.0, 1.0),
    "ShaderNodeTexGradient": partial(_within, 0.0, 1.0),
    "ShaderNodeTexWave": partial(_within, 0.0, 1.0),
}
