# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets and finishes on materials: what they set, what they leave, and when they refuse."""

import shutil

import pytest

from addon.core.kinds import KINDS
from addon.core.presets import catalogue as presets
from blender_tests.addon.operators.test_operators import linked_objects, new_object
from blender_tests.addon.support import surface_material

pytestmark = pytest.mark.usefixtures("compiled_once")

OTHER = {"CONDUCTOR": "DIELECTRIC", "DIELECTRIC": "DIFFUSE", "DIFFUSE": "CONDUCTOR"}


@pytest.fixture
def fresh_presets():
    """Presets are read again before and after the test."""
    presets.clear_cache()
    yield presets
    presets.clear_cache()


def first_preset(kind):
    return presets.presets(kind)[0]


def value(node, parameter):
    found = node.inputs[parameter.label].default_value
    return tuple(found)[:3] if parameter.is_vector else found


def holds(node, kind, values):
    known = KINDS[kind].by_identifier
    for identifier, wanted in values.items():
        assert value(node, known[identifier]) == pytest.approx(wanted, rel=1e-6), identifier
    return True


def state(material):
    """What a preset could change: links, and the values of all inputs."""
    tree = material.node_tree
    links = sorted(
        (link.from_node.name, link.to_node.name, link.to_socket.name) for link in tree.links
    )
    values = {}
    for node in tree.nodes:
        for socket in node.inputs:
            found = getattr(socket, "default_value", None)
            key = (node.name, socket.identifier)
            values[key] = tuple(found) if hasattr(found, "__len__") else found
    return links, values


def our_material(kind, **values):
    from addon.material.node import material_node, new_material

    material = new_material(kind, "Ours", **values)
    return material, material_node(material)


def test_values_of_the_preset_are_set_and_others_stay(registered, kind):
    from addon.presets.apply import PRESET_KEY, apply_preset

    material, node = our_material(kind, Quality="Walk", Walks=7, Rotation=0.25)
    preset = first_preset(kind)
    assert apply_preset(material, preset) == []
    assert holds(node, kind, preset.values)
    assert holds(node, kind, {"Quality": 2, "Walks": 7, "Rotation": 0.25})
    assert node[PRESET_KEY] == preset.identifier
    assert len(material.node_tree.nodes) == 2


def test_a_linked_input_keeps_its_link(registered, kind):
    from addon.presets.apply import apply_preset

    material, node = our_material(kind)
    preset = first_preset(kind)
    parameter = KINDS[kind].by_identifier[next(iter(preset.values))]
    tree = material.node_tree
    source = tree.nodes.new("ShaderNodeRGB")
    tree.links.new(source.outputs[0], node.inputs[parameter.label])
    before = value(node, parameter)
    assert apply_preset(material, preset) == [parameter.label]
    assert node.inputs[parameter.label].links[0].from_node == source
    assert value(node, parameter) == before
    rest = {key: item for key, item in preset.values.items() if key != parameter.identifier}
    assert holds(node, kind, rest)


def test_a_material_of_another_kind_gets_a_node_beside_its_own(registered, kind):
    from addon.material.graph import node_kind
    from addon.material.node import material_node
    from addon.presets.apply import apply_preset

    material, old = our_material(OTHER[kind], Roughness=0.9)
    before = {socket.name: socket for socket in old.inputs}
    preset = first_preset(kind)
    apply_preset(material, preset)
    node = material_node(material)
    assert node_kind(node) == kind
    assert holds(node, kind, preset.values)
    assert old.name in material.node_tree.nodes
    assert not old.outputs["BSDF"].is_linked
    assert before["Roughness"].default_value == pytest.approx(0.9)
    assert tuple(node.location) != tuple(old.location)
    apply_preset(material, first_preset(OTHER[kind]))
    assert len([n for n in material.node_tree.nodes if node_kind(n)]) == 3, "the old is no target"


def test_of_several_nodes_the_active_then_a_selected_one_is_taken(registered):
    from addon.material.group import add_group_node, material_group
    from addon.material.node import material_node

    material, first = our_material("CONDUCTOR")
    tree = material.node_tree
    second = add_group_node(tree, material_group("CONDUCTOR"))
    glass = add_group_node(tree, material_group("DIELECTRIC"))
    stray = add_group_node(tree, material_group("CONDUCTOR"))
    output = tree.get_output_node("CYCLES")
    mixes = [tree.nodes.new("ShaderNodeMixShader") for _ in range(2)]
    for target, shader in (
        (mixes[1].inputs[1], first),
        (mixes[1].inputs[2], second),
        (mixes[0].inputs[1], mixes[1]),
        (mixes[0].inputs[2], glass),
        (output.inputs["Surface"], mixes[0]),
    ):
        tree.links.new(shader.outputs[0], target)
    for node in tree.nodes:
        node.select = False
    tree.nodes.active = stray
    stray.select = True
    assert material_node(material) == glass, "the nearest to the output; the stray feeds nothing"
    assert material_node(material, "CONDUCTOR") == first
    second.select = True
    assert material_node(material) == second
    tree.nodes.active = first
    assert material_node(material) == first
    assert material_node(material, "DIELECTRIC") == glass
    assert material_node(material, "DIFFUSE") is None


def test_materials_without_nodes_or_output(registered, kind):
    from addon.material.node import material_node
    from addon.presets.apply import apply_preset

    preset = first_preset(kind)
    plain = registered.data.materials.new("Plain")
    empty, tree, _ = surface_material("Empty")
    tree.nodes.clear()
    for material in (plain, empty):
        assert apply_preset(material, preset) == []
        assert holds(material_node(material), kind, preset.values)
        if registered.app.version < (5, 0, 0):
            assert material.use_nodes


def test_nodes_that_are_switched_off_are_kept_and_switched_on(registered):
    from addon.material.graph import surface_tree
    from addon.presets.apply import apply_preset

    material, tree, _ = surface_material("Off")
    tree.nodes.new("ShaderNodeBsdfSheen")
    if registered.app.version < (5, 0, 0):  # later they are always on
        material.use_nodes = False
        assert surface_tree(material) is None
    apply_preset(material, first_preset("CONDUCTOR"))
    found = [node.bl_idname for node in surface_tree(material).nodes]
    assert "ShaderNodeBsdfSheen" in found
    assert "ShaderNodeGroup" in found


def test_finish_goes_over_the_preset_and_is_refused_for_other_kinds(registered):
    from addon.material.node import MaterialError, material_node
    from addon.presets.apply import apply_finish, apply_preset

    for finish in presets.finishes():
        for kind in KINDS:
            preset = first_preset(kind)
            material, node = our_material(kind)
            if kind in finish.kinds:
                apply_preset(material, preset, finish)
                assert holds(node, kind, {**preset.values, **finish.values})
                continue
            before = state(material)
            with pytest.raises(MaterialError, match="choose another finish"):
                apply_preset(material, preset, finish)
            with pytest.raises(MaterialError, match="apply a preset of that kind first"):
                apply_finish(material, finish)
            assert state(material) == before
    plain, _, _ = surface_material("Plain")
    with pytest.raises(MaterialError, match="that feeds the output of 'Plain'"):
        apply_finish(plain, presets.finishes()[0])
    assert material_node(plain) is None


@pytest.mark.parametrize(
    ("values", "error", "words"),
    [
        ({"Roughness": 0.1, "Sheen": 1.0}, TypeError, "has no 'Sheen': use one of"),
        ({"Roughness": 0.1, "Walks": 99}, ValueError, "it goes from 1 to 16"),
        ({"Roughness": "rough"}, TypeError, "give a number"),
        ({"Roughness": float("nan")}, ValueError, "it goes from 0 to 1"),
    ],
)
def test_bad_values_change_nothing(registered, kind, values, error, words):
    from addon.material.node import set_values

    material, node = our_material(kind)
    before = state(material)
    with pytest.raises(error, match=words):
        set_values(node, values)
    assert state(material) == before


def test_operator_gives_an_empty_slot_a_material_of_that_name(registered, kind):
    from addon.material.node import material_node
    from addon.presets.apply import NEW_VALUES

    preset = first_preset(kind)
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    apply = registered.ops.microbounce.apply_preset
    assert apply(identifier=preset.identifier) == {"FINISHED"}
    assert obj.active_material.name == preset.name
    node = material_node(obj.active_material)
    assert holds(node, kind, {**NEW_VALUES[kind], **preset.values})
    node.inputs["Roughness"].default_value = 0.77
    apply(identifier=first_preset(OTHER[kind]).identifier)
    assert len(registered.data.materials) == 1, "the same material has another node"


def test_operator_applies_a_finish_with_it_or_later(registered):
    from addon.material.node import material_node

    finish = presets.finishes("CONDUCTOR")[0]
    preset = first_preset("CONDUCTOR")
    new_object(registered, registered.data.meshes.new("Mesh"))
    ops = registered.ops.microbounce
    ops.apply_preset(identifier=preset.identifier, finish=finish.identifier)
    node = material_node(registered.context.object.active_material)
    assert holds(node, "CONDUCTOR", finish.values)
    node.inputs["Roughness"].default_value = 0.99
    assert ops.apply_finish(identifier=finish.identifier) == {"FINISHED"}
    assert holds(node, "CONDUCTOR", {**preset.values, **finish.values})


def test_operators_name_what_is_unknown_and_change_nothing(registered):
    ops = registered.ops.microbounce
    new_object(registered, registered.data.meshes.new("Mesh"))
    close = first_preset("CONDUCTOR").identifier
    with pytest.raises(RuntimeError, match=f"did you mean .*{close}"):
        ops.apply_preset(identifier=f"{close}x")
    with pytest.raises(RuntimeError, match="There is no finish"):
        ops.apply_preset(identifier=close, finish="finish/unheard-of")
    other = next(f for f in presets.finishes() if len(f.kinds) < len(KINDS))
    kind = next(kind for kind in KINDS if kind not in other.kinds)
    with pytest.raises(RuntimeError, match="choose another finish"):
        ops.apply_preset(identifier=first_preset(kind).identifier, finish=other.identifier)
    assert not registered.data.materials
    with pytest.raises(RuntimeError, match="apply a preset first"):
        ops.apply_finish(identifier=other.identifier)


def test_applying_can_be_undone(registered, kind):
    bpy = registered
    bpy.context.preferences.edit.use_global_undo = True
    material, _ = our_material(kind)
    new_object(bpy, bpy.data.meshes.new("Mesh")).data.materials.append(material)
    before = state(material)
    bpy.ops.ed.undo_push(message="Before")
    for other in (kind, OTHER[kind]):
        bpy.ops.microbounce.apply_preset(identifier=first_preset(other).identifier)
        bpy.ops.ed.undo_push(message="After")
        assert state(bpy.data.materials["Ours"]) != before
        bpy.ops.ed.undo()
        assert state(bpy.data.materials["Ours"]) == before


def test_linked_material_is_refused_and_its_file_untouched(registered, tmp_path):
    linked = linked_objects(registered, tmp_path, with_slot=True)
    obj = new_object(registered, registered.data.meshes.new("Mesh"))
    obj.data.materials.append(linked.active_material)
    path = tmp_path / "library.blend"
    content = path.read_bytes()
    apply = registered.ops.microbounce.apply_preset
    identifier = first_preset("CONDUCTOR").identifier
    assert not apply.poll()
    with pytest.raises(RuntimeError, match="'Library Material' is linked from a library: make it"):
        apply(identifier=identifier)
    from addon.material.node import MaterialError
    from addon.presets.apply import apply_preset

    with pytest.raises(MaterialError, match="make it local"):
        apply_preset(linked.active_material, presets.preset(identifier))
    assert path.read_bytes() == content


@pytest.mark.parametrize("name", ["apply_preset", "search_preset", "apply_finish"])
def test_without_a_target_the_operators_say_why(registered, name):
    operator = getattr(registered.ops.microbounce, name)
    assert not operator.poll()
    arguments = {} if name == "search_preset" else {"identifier": "conductor/gold"}
    with pytest.raises(RuntimeError, match=r"There is no active object|apply a preset first"):
        operator(**arguments)
    rna = operator.get_rna_type()
    assert operator.bl_options >= {"REGISTER", "UNDO"}
    assert rna.name == rna.name.title()
    assert not rna.description.endswith(".")


def test_search_finds_all_presets_by_name_kind_and_tags(registered):
    from addon.operators.presets import search_items

    items = search_items()
    assert [item[0] for item in items] == [preset.identifier for preset in presets.presets()]
    for item, preset in zip(items, presets.presets(), strict=True):
        for word in (preset.name, KINDS[preset.kind].label, *preset.tags):
            assert word in item[1]
        assert preset.source.title.rstrip(".") in item[2]
        assert not item[2].endswith(".")
    assert search_items() is items, "Blender needs the texts to stay"
    new_object(registered, registered.data.meshes.new("Mesh"))
    identifier = items[-1][0]
    assert registered.ops.microbounce.search_preset(identifier=identifier) == {"FINISHED"}
    assert registered.data.materials[0].name == presets.preset(identifier).name


def test_search_shows_the_pictures(registered, monkeypatch):
    from addon.operators import presets as ops

    numbers = {preset.identifier: 100 + n for n, preset in enumerate(presets.presets())}
    monkeypatch.setattr(ops, "icon", numbers.get)  # without a window all icons are 0
    items = ops.search_items()
    assert {item[0]: item[3] for item in items} == numbers
    assert [item[4] for item in items] == list(range(len(numbers)))
    new_object(registered, registered.data.meshes.new("Mesh"))
    registered.ops.microbounce.search_preset(identifier="conductor/gold")
    assert registered.data.materials[0].name == "Gold"


def test_a_corrupted_preset_is_named_and_others_work(
    registered, tmp_path, monkeypatch, fresh_presets
):
    folder = tmp_path / "presets"
    shutil.copytree(presets.FOLDER, folder)
    bad, good = first_preset("CONDUCTOR"), first_preset("DIELECTRIC")
    (folder / f"{bad.identifier}.toml").write_text("name = ", encoding="utf-8")
    monkeypatch.setattr(presets, "FOLDER", folder)
    presets.clear_cache()
    new_object(registered, registered.data.meshes.new("Mesh"))
    apply = registered.ops.microbounce.apply_preset
    with pytest.raises(RuntimeError, match="There is no preset"):
        apply(identifier=bad.identifier)
    assert not registered.data.materials
    assert apply(identifier=good.identifier) == {"FINISHED"}
    (problem,) = presets.problems()
    assert bad.identifier in problem
