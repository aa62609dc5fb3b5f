# SPDX-License-Identifier: GPL-3.0-or-later
"""A kept reference is found again, and never for a scene that it is not of."""

import os

import bpy
import numpy as np
import pytest

from addon.core.cost.plan import Options
from addon.cost import reference_cache
from addon.cost.reference_cache import cache_file, clear_cache, load_reference, store_reference
from blender_tests.addon.cost.cost_support import dump, tiny_scene

PICTURES = [np.full((4, 6, 3), value, np.float32) for value in (1.0, 2.0)]


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """A cache of its own."""
    monkeypatch.setattr(reference_cache, "cache_folder", lambda: tmp_path / "cache")
    return tmp_path / "cache"


@pytest.fixture
def key(registered, compiled_once, tmp_path):
    """Returns where the reference of the open scene is kept, with options as given."""
    tiny_scene(tmp_path / "tiny.blend")

    def found(**options):
        scene = bpy.context.scene
        return cache_file(scene, "ViewLayer", Options(**options), unchanged=True)

    return found


def _ours():
    return bpy.data.materials["Ours"].node_tree.nodes["Microbounce Conductor"]


def _set_roughness():
    _ours().inputs["Roughness"].default_value = 0.31


def _add_group_node():
    bpy.data.node_groups[0].nodes.new("ShaderNodeMath")


def _clamp():
    bpy.context.scene.cycles.sample_clamp_indirect = 3.0


def _move():
    bpy.data.objects["Sphere"].location.x = 0.2
    bpy.context.view_layer.update()


def _hide():
    bpy.data.objects["Sphere"].hide_render = True


def _dim():
    bpy.data.lights[0].energy = 7.0


def _turn_camera():
    bpy.data.cameras[0].lens = 20.0


def _next_frame():
    bpy.context.scene.frame_set(9)


def _samples():
    bpy.context.scene.cycles.samples = 5


def _swap_material():
    bpy.data.objects["Sphere"].material_slots[0].material = None


def _save_file():
    os.utime(bpy.data.filepath, ns=(1, 1))


@pytest.mark.parametrize(
    "change",
    [
        _set_roughness, _add_group_node, _clamp, _move, _hide, _dim, _turn_camera, _next_frame,
        _samples, _swap_material, _save_file,
    ],
)  # fmt: skip
def test_a_changed_scene_has_another_reference(key, change):
    before = key()
    assert key() == before
    change()
    assert key() != before


def test_other_options_have_another_reference_where_it_depends_on_them(key):
    before = key()
    for options in (
        {"samples": 8},
        {"percentage": 10},
        {"reference": "EXACT"},
        {"reference_samples": 9},
        {"region": (0.0, 0.0, 0.5, 0.5)},
    ):
        assert key(**options) != before, options
    assert key(steps=("Walk",), rounds=7, error=0.1, baselines=False, bounces=(3,)) == before


def test_textures_count_with_all_files_of_their_folder(key, tmp_path):
    textures = tmp_path / "textures"
    textures.mkdir()
    for number in (1, 2):
        image = bpy.data.images.new("made", 4, 4)
        image.save(filepath=str(textures / f"stone.{number}.png"))
        bpy.data.images.remove(image)
    image = bpy.data.images.load(str(textures / "stone.1.png"))
    image.use_fake_user = True
    before = key()
    assert key() == before
    os.utime(textures / "stone.2.png", ns=(5, 5))
    after = key()
    assert after != before
    (textures / "stone.1.png").unlink()
    assert key() not in (before, after)


def test_the_key_changes_nothing(key):
    before = dump()
    key()
    assert dump() == before


def test_what_may_have_changed_is_not_kept(key, registered):
    scene = bpy.context.scene
    assert key() != ""
    assert cache_file(scene, "ViewLayer", Options()) == "", "nothing tells it in the background"
    scene = tiny_scene()
    assert cache_file(scene, "ViewLayer", Options(), unchanged=True) == "", "never saved"


def test_kept_and_loaded(folder):
    path = str(folder / "a.npz")
    assert load_reference(path) is None
    assert store_reference(path, PICTURES)
    assert all(np.array_equal(a, b) for a, b in zip(load_reference(path), PICTURES, strict=True))
    assert [file.name for file in folder.iterdir()] == ["a.npz"]
    assert load_reference("") is None
    assert store_reference("", PICTURES) is False


@pytest.mark.parametrize("size", [0, 10, 200, -30])
def test_a_file_that_breaks_off_is_not_taken(folder, size):
    path = folder / "a.npz"
    store_reference(str(path), PICTURES)
    path.write_bytes(path.read_bytes()[:size])
    assert load_reference(str(path)) is None


def test_a_damaged_file_is_not_taken(folder):
    path = folder / "a.npz"
    store_reference(str(path), PICTURES)
    content = bytearray(path.read_bytes())
    content[200] ^= 255
    path.write_bytes(content)
    assert load_reference(str(path)) is None
    np.savez(path, first=PICTURES[0], second=PICTURES[0][1:])
    assert load_reference(str(path)) is None
    np.savez(path, first=PICTURES[0], other=1)
    assert load_reference(str(path)) is None
    np.save(path.with_suffix(".npy"), PICTURES[0])
    path.with_suffix(".npy").replace(path)
    assert load_reference(str(path)) is None


def test_a_folder_that_cannot_be_written(folder):
    folder.write_text("a file in its place", "utf-8")
    assert store_reference(str(folder / "a.npz"), PICTURES) is False


def test_the_oldest_go(folder):
    paths = [folder / f"{number}.npz" for number in range(10)]
    for number, path in enumerate(paths):
        store_reference(str(path), PICTURES)
        os.utime(path, (number, number))
        if number == 5:
            load_reference(str(paths[0]))  # it is used, so it stays
    assert sorted(file.name for file in folder.iterdir()) == [
        f"{number}.npz" for number in (0, 3, 4, 5, 6, 7, 8, 9)
    ]


def test_cleared(folder):
    assert clear_cache() == 0
    store_reference(str(folder / "a.npz"), PICTURES)
    assert clear_cache() == 1
    assert not folder.exists()


def test_the_folder_without_an_extension(monkeypatch, tmp_path):
    monkeypatch.undo()
    monkeypatch.setattr(reference_cache.tempfile, "tempdir", str(tmp_path))
    assert reference_cache.cache_folder() == tmp_path / "microbounce_cost_references"
