# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups: sockets against the parameters, reuse, and failures that leave nothing behind."""

import hashlib
import re
import tempfile
from dataclasses import replace

import pytest

from addon.core import VERSION
from addon.core.kinds import KINDS
from addon.core.oso import oso_parameters
from addon.core.shader_source import ShaderSourceError, inlined_source
from addon.material.node import new_material
from blender_tests.addon.support import ROOT

# What GROUP_REVISION stands for. If its test fails, raise it in addon/material/group.py and replace
# the digests. Files then take the new groups; build the scenes again with `make scenes`.
REVISION = 4
DIGESTS = {
    "CONDUCTOR": "1618d335a64f3973",
    "DIELECTRIC": "5e4e28d5bfb994ad",
    "DIFFUSE": "ee82e2562fdff290",
}

# Blender stores sockets as 32-bit floats; so do compiled shaders.
FLOAT32 = 1e-6

SOCKETS = {
    "COLOR": "NodeSocketColor",
    "FLOAT": "NodeSocketFloat",
    "INT": "NodeSocketInt",
    "VECTOR": "NodeSocketVector",
    "NORMAL": "NodeSocketVector",
    "TANGENT": "NodeSocketVector",
}


@pytest.fixture
def group_module(empty_file):
    from addon.material import group

    return group


def numbers(value):
    return list(value) if hasattr(value, "__len__") else [value]


def contents(bpy):
    blocks = (bpy.data.node_groups, bpy.data.texts, bpy.data.materials)
    return [sorted(block.name for block in collection) for collection in blocks]


def test_shader_declares_the_parameters(group_module, kind):
    from addon.material.script import compile_source

    declared = oso_parameters(compile_source(inlined_source(KINDS[kind].shader)))
    inputs = [p for p in declared if not p.output]
    assert [p.name for p in inputs] == [p.identifier for p in KINDS[kind].parameters]
    types = {"COLOR": "color", "FLOAT": "float", "INT": "int", "NORMAL": "normal"}
    for shader, parameter in zip(inputs, KINDS[kind].parameters, strict=True):
        assert shader.type == types.get(parameter.type, "vector"), shader.name
        if not shader.computed:
            assert list(shader.default) == pytest.approx(numbers(parameter.default), rel=FLOAT32)
    assert [(p.name, p.type) for p in declared if p.output] == [
        ("BSDF", "closure color"),
        ("Active", "float"),
    ]


def test_sockets_are_the_parameters(group_module, kind):
    group = group_module.material_group(kind)
    sockets = {item.name: item for item in group.interface.items_tree if item.item_type == "SOCKET"}
    assert sockets.pop("BSDF").socket_type == "NodeSocketShader"
    assert set(sockets) == {parameter.label for parameter in KINDS[kind].parameters}
    for parameter in KINDS[kind].parameters:
        socket = sockets[parameter.label]
        assert socket.in_out == "INPUT"
        assert socket.socket_type == SOCKETS[parameter.type]
        assert socket.description == parameter.description
        default = numbers(parameter.default) + [1.0] * (parameter.type == "COLOR")
        assert numbers(socket.default_value) == pytest.approx(default, rel=FLOAT32)
        assert socket.hide_value == (parameter.type in ("NORMAL", "TANGENT"))
        assert socket.parent.name == parameter.panel
        if parameter.type != "COLOR":
            limits = (socket.min_value, socket.max_value)
            assert limits == pytest.approx(parameter.legal, rel=FLOAT32)


def test_script_node_carries_source_and_bytecode(group_module, kind):
    group = group_module.material_group(kind)
    (script,) = [node for node in group.nodes if node.bl_idname == "ShaderNodeScript"]
    assert script.script.as_string() == inlined_source(KINDS[kind].shader)
    assert script.bytecode.startswith("OpenShadingLanguage")
    assert script.bytecode_hash
    assert [s.identifier for s in script.inputs] == [p.identifier for p in KINDS[kind].parameters]
    assert all(socket.is_linked for socket in script.inputs)
    assert [s.identifier for s in script.outputs] == ["BSDF", "Active"]
    (factor,) = [link.to_socket for link in script.outputs["Active"].links]
    assert factor.default_value == 0.0, "the fallback would not show without OSL"


def test_bytecode_names_no_folder_and_is_reproducible(group_module, kind):
    from addon.material.script import compile_source

    source = inlined_source(KINDS[kind].shader)
    bytecode = compile_source(source)
    assert '%filename{"shader.osl"}' in bytecode
    names = re.findall(r'%filename\{"([^"]*)"', bytecode)
    assert not [name for name in names if "/" in name or "\\" in name]
    assert tempfile.gettempdir() not in bytecode
    assert compile_source(source) == bytecode


def test_group_is_stamped_and_reused(group_module, kind, empty_file):
    group = group_module.material_group(kind)
    assert group[group_module.VERSION_KEY] == VERSION
    assert VERSION in group.description
    assert group_module.material_group(kind) == group
    made = KINDS[kind]
    assert group[group_module.KIND_KEY] == kind
    assert contents(empty_file)[:2] == [[made.name], [f"{made.shader}.osl"]]


def described(group):
    """Everything that the builder decides, in words that every Blender version gives alike."""
    for item in group.interface.items_tree:
        yield item.item_type, item.name, item.parent.name
        if item.item_type == "PANEL":
            yield (item.default_closed,)
        else:
            hidden = item.in_out == "INPUT" and item.hide_value
            yield item.in_out, item.socket_type, getattr(item, "subtype", ""), hidden
    settings = ("operation", "data_type", "distribution", "fresnel_type", "mode")
    for node in group.nodes:
        yield node.bl_idname, node.name, *(str(getattr(node, name, "")) for name in settings)
        # What the parameters or the Blender version decide is left out: the sockets of those nodes.
        if node.bl_idname in ("ShaderNodeMixShader", "ShaderNodeMath"):
            yield tuple(
                socket.default_value
                for socket in node.inputs
                if socket.type == "VALUE" and not socket.is_linked
            )
    for link in group.links:
        ends = (link.from_node, link.to_node)
        yield *(end.name for end in ends), link.from_socket.name, link.to_socket.identifier


def test_group_revision_stands_for_what_is_built(group_module, kind):
    # Input sockets of a group have identifiers that Blender numbers; names are stable there.
    text = "\n".join(repr(line) for line in described(group_module.material_group(kind)))
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    assert (group_module.GROUP_REVISION, digest) == (REVISION, DIGESTS[kind]), (
        f"built differently:\n{text}"
    )


@pytest.mark.parametrize("name", ["VERSION", "GROUP_REVISION", "parameters"])
def test_stamp_changes_with_all_that_the_group_is_made_from(group_module, kind, monkeypatch, name):
    old = group_module.material_group(kind)
    if name == "parameters":
        first, *others = KINDS[kind].parameters
        changed = (replace(first, tooltip="Another tooltip"), *others)
        monkeypatch.setitem(KINDS, kind, replace(KINDS[kind], parameters=changed))
    else:
        value = {"VERSION": "0.1.1", "GROUP_REVISION": group_module.GROUP_REVISION + 1}[name]
        monkeypatch.setattr(group_module, name, value)
    assert group_module.material_group(kind) != old


def test_group_of_another_version_is_left_alone(group_module, kind, empty_file):
    old = group_module.material_group(kind)
    old[group_module.STAMP_KEY] = "0123456789abcdef"
    new = group_module.material_group(kind)
    assert new != old
    assert len(empty_file.data.node_groups) == 2


def test_material_takes_values(group_module, kind):
    color = KINDS[kind].parameters[0]
    values = {color.identifier: (1, 0.8, 0.3), "Roughness": 0.8}
    material = new_material(kind, "New", Quality="Exact", BounceOnly=5, **values)
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    assert list(node.inputs[color.label].default_value) == pytest.approx([1, 0.8, 0.3, 1])
    assert node.inputs["Roughness"].default_value == pytest.approx(0.8)
    assert node.inputs["Quality"].default_value == 3
    assert node.inputs["Bounce Only"].default_value == 5
    assert node.outputs["BSDF"].links[0].to_node.bl_idname == "ShaderNodeOutputMaterial"


@pytest.mark.parametrize(
    ("values", "error"),
    [({"Rough": 1}, TypeError), ({"Roughness": 2}, ValueError), ({"Walks": 1.5}, TypeError)],
)
def test_material_with_bad_values_is_not_made(group_module, kind, empty_file, values, error):
    before = contents(empty_file)
    with pytest.raises(error, match=next(iter(values))):
        new_material(kind, "Bad", **values)
    assert contents(empty_file) == before


@pytest.mark.parametrize(
    ("source", "error", "words"),
    [
        ("shader toy(float a = 0) { a = ; }", "ShaderCompileError", "shader.osl:"),
        ("shader toy(float a = 0) { }", "ValueError", "The shader declares a; the extension"),
        (None, "ShaderSourceError", "Reinstall the extension"),
    ],
)
def test_a_failure_leaves_the_file_as_it_was(
    group_module, kind, empty_file, monkeypatch, source, error, words
):
    def damaged(name):
        if source is None:
            raise ShaderSourceError(f"{name}.osl is missing. Reinstall the extension")
        return source

    monkeypatch.setattr(group_module, "inlined_source", damaged)
    before = contents(empty_file)
    with pytest.raises((RuntimeError, ValueError)) as caught:
        new_material(kind, "Bad")
    assert type(caught.value).__name__ == error
    assert words in str(caught.value)
    assert contents(empty_file) == before


def test_compiler_message_names_line_and_cause(empty_file):
    from addon.material.script import ShaderCompileError, compile_source

    with pytest.raises(ShaderCompileError) as caught:
        compile_source("shader toy(float a = 0)\n{\n    a = missing_name;\n}\n")
    assert "'missing_name' was not declared" in str(caught.value)
    assert tempfile.gettempdir() not in str(caught.value)


def test_unwritable_temporary_folder_names_remedy(
    group_module, kind, empty_file, monkeypatch, tmp_path
):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    before = contents(empty_file)
    with pytest.raises(RuntimeError, match=r"temporary folder.*gone.*TMPDIR"):
        group_module.material_group(kind)
    assert contents(empty_file) == before


def test_nothing_is_written_beside_the_extension(group_module, kind):
    def files():
        found = [*(ROOT / "addon").rglob("*"), *(ROOT / "osl").rglob("*")]
        return {(p, p.stat().st_mtime_ns) for p in found if "__pycache__" not in p.parts}

    before = files()
    new_material(kind, "New")
    assert files() == before


def test_without_a_compiler_the_group_is_made_and_completed_later(
    group_module, kind, empty_file, monkeypatch
):
    from addon.material import script

    with monkeypatch.context() as patch:
        patch.setattr(script, "osl_compiler_available", lambda: False)
        material = new_material(kind, "New")
        group = group_module.material_group(kind)
        assert not group_module.has_bytecode(group)
    completed = group_module.material_group(kind)
    assert group_module.has_bytecode(completed)
    assert completed.name == KINDS[kind].name
    (node,) = [n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup"]
    assert node.node_tree == completed
    assert len(empty_file.data.node_groups) == 1
