# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group of a material: the shader, and a native fallback beside it.

The script node's output `Active` drives a Mix Shader whose own factor is 0. It is 1 if the script
runs, and the native closures then have weight 0. Without OSL (EEVEE, most GPUs, OSL switched off or
not built in) Cycles and EEVEE leave the script out, the factor stays 0, and the native closure
shows. That needs no handler, driver or extension in the file.
"""

import hashlib

import bpy

from ..core import VERSION
from ..core.kinds import Kind, kind_named
from ..core.parameter import Parameter
from ..core.parameters import FRESNEL_PANEL
from ..core.shader_source import ShaderSourceError, inlined_source
from .directions import make_directions
from .fallback import make_fallback
from .graph import KIND_KEY, socket_named
from .script import OslUnavailableError, ShaderCompileError, compile_source, fill_script_node
from .sockets import SOCKET_TYPES, socket_value

VERSION_KEY = "microbounce_version"
STAMP_KEY = "microbounce_stamp"

# Raised by a damaged installation or a full disk. The messages are for users.
GROUP_ERRORS = (ShaderSourceError, ShaderCompileError, ValueError, OSError)

# Raise it if other sockets, nodes, settings or links are made, here or by the makers. Files then
# get the new group beside their old one. A test knows what each number stands for.
GROUP_REVISION = 4

_SUBTYPES = {"rad": "ANGLE", "turns": "FACTOR"}


def material_group(kind: str) -> bpy.types.ShaderNodeTree:
    """Return the node group of a kind of material; reuse the file's own if it has today's.

    A group linked from a library is not reused, because the file has to render alone. Nor is a
    group whose sockets or script node a user removed. In a Blender without OSL the group has no
    bytecode and shows its fallback. A later call in a Blender with OSL completes it, with a deleted
    text block too. Raises ValueError for an unknown kind and one of GROUP_ERRORS; the file is then
    as it was.
    """
    made = kind_named(kind)
    source = inlined_source(made.shader)
    stamp = group_stamp(made, source)
    group = _group_with(stamp, made)
    script = script_node(group) if group is not None else None
    if script is not None and script.bytecode and script.script is not None:
        return group
    try:
        bytecode = compile_source(source)
    except OslUnavailableError:
        bytecode = script.bytecode if script is not None else ""
    if script is None:
        return _build_group(made, source, bytecode, stamp)
    _fill_script(script, made, source, bytecode)
    return group


def add_group_node(
    tree: bpy.types.ShaderNodeTree, group: bpy.types.ShaderNodeTree
) -> bpy.types.ShaderNodeGroup:
    """Add a node of one of our groups to `tree` at the origin and return it."""
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    node.name = node.label = kind_named(group[KIND_KEY]).name
    node.width = group.default_group_node_width
    return node


def script_node(group: bpy.types.ShaderNodeTree) -> bpy.types.Node | None:
    """Return the group's script node, None if it has none."""
    return next((node for node in group.nodes if node.bl_idname == "ShaderNodeScript"), None)


def has_bytecode(group: bpy.types.ShaderNodeTree) -> bool:
    """Return whether the group's script can run."""
    script = script_node(group)
    return script is not None and bool(script.bytecode)


def group_stamp(kind: Kind, source: str) -> str:
    """Return a digest of all that this group is made from. It tells versions apart."""
    made_from = f"{VERSION} {GROUP_REVISION} {kind!r} {source}"
    return hashlib.sha256(made_from.encode()).hexdigest()[:16]


def _group_with(stamp: str, kind: Kind) -> bpy.types.ShaderNodeTree | None:
    labels = {parameter.label for parameter in kind.parameters}
    for group in bpy.data.node_groups:
        if group.get(STAMP_KEY) != stamp or group.library or group.override_library:
            continue
        sockets = {item.name for item in group.interface.items_tree if item.item_type == "SOCKET"}
        if sockets >= {"BSDF", *labels} and script_node(group) is not None:
            return group
    return None


def _build_group(kind: Kind, source: str, bytecode: str, stamp: str) -> bpy.types.ShaderNodeTree:
    texts = set(bpy.data.texts)
    group = bpy.data.node_groups.new(kind.name, "ShaderNodeTree")
    try:
        _make_interface(group, kind)
        _make_nodes(group, kind, source, bytecode)
    except Exception:
        bpy.data.node_groups.remove(group)
        for text in set(bpy.data.texts) - texts:
            bpy.data.texts.remove(text)
        raise
    group.color_tag = "SHADER"
    group.default_group_node_width = 240
    group.description = (
        f"Microbounce {VERSION}. {kind.surface} with the light of several bounces on its "
        "microsurface, in Cycles with Open Shading Language; elsewhere Cycles' own material shows"
    )
    group[KIND_KEY] = kind.identifier
    group[VERSION_KEY] = VERSION
    group[STAMP_KEY] = stamp
    return group


def _make_interface(group: bpy.types.ShaderNodeTree, kind: Kind) -> None:
    interface = group.interface
    interface.new_socket("BSDF", in_out="OUTPUT", socket_type="NodeSocketShader")
    # Blender keeps panels below the sockets that are in none.
    for parameter in kind.parameters:
        if not parameter.panel:
            _make_socket(interface, parameter, None)
    for name in dict.fromkeys(parameter.panel for parameter in kind.parameters if parameter.panel):
        panel = interface.new_panel(name, default_closed=name == FRESNEL_PANEL)
        for parameter in kind.parameters:
            if parameter.panel == name:
                _make_socket(interface, parameter, panel)


def _make_socket(
    interface: bpy.types.NodeTreeInterface,
    parameter: Parameter,
    panel: bpy.types.NodeTreeInterfacePanel | None,
) -> None:
    socket = interface.new_socket(
        parameter.label,
        description=parameter.description,
        in_out="INPUT",
        socket_type=SOCKET_TYPES[parameter.type],
        parent=panel,
    )
    if parameter.type == "FLOAT":
        plain = "FACTOR" if parameter.legal == (0.0, 1.0) else "NONE"
        socket.subtype = _SUBTYPES.get(parameter.unit, plain)
    if parameter.type != "COLOR":
        socket.min_value, socket.max_value = parameter.legal
    socket.default_value = socket_value(parameter, parameter.default)
    # A hidden value also tells Cycles and EEVEE that an unlinked input means the surface's own.
    socket.hide_value = parameter.type in ("NORMAL", "TANGENT")


def _make_nodes(group: bpy.types.ShaderNodeTree, kind: Kind, source: str, bytecode: str) -> None:
    nodes, links = group.nodes, group.links
    inputs = nodes.new("NodeGroupInput")
    inputs.location = (-600, 0)
    script = nodes.new("ShaderNodeScript")
    script.name = script.label = "Multiple Bounces"
    script.location = (-200, 620)
    script.width = 240
    _fill_script(script, kind, source, bytecode)
    directions = make_directions(group, inputs)
    for parameter in kind.parameters:
        value = inputs.outputs[parameter.label]
        # The tangent about the object's z axis needs generated coordinates. Cycles makes these only
        # for native nodes that ask for them.
        if parameter.identifier == "Tangent":
            value = directions.tangent
        links.new(value, socket_named(script.inputs, parameter.identifier))

    switch = nodes.new("ShaderNodeMixShader")
    switch.name = switch.label = "Fallback Unless Active"
    switch.location = (600, 100)
    switch.inputs[0].default_value = 0.0
    links.new(script.outputs["Active"], switch.inputs[0])
    links.new(make_fallback(kind, group, inputs, directions), switch.inputs[1])
    links.new(script.outputs["BSDF"], switch.inputs[2])

    output = nodes.new("NodeGroupOutput")
    output.location = (800, 100)
    links.new(switch.outputs[0], output.inputs["BSDF"])
    for node in nodes:
        node.select = False


def _fill_script(script: bpy.types.Node, kind: Kind, source: str, bytecode: str) -> None:
    fill_script_node(script, kind.parameters, source, bytecode, f"{kind.shader}.osl")
