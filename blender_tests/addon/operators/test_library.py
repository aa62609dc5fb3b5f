# SPDX-License-Identifier: GPL-3.0-or-later
"""The asset library: what it holds, how it gets into the zip and the preferences."""

import uuid
from pathlib import Path

import numpy as np
import pytest
import zstandard

from addon.core.kinds import KINDS
from addon.core.presets import catalogue as presets
from tools.release import assets, extension
from tools.release.repack import repack


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The folder of a library that was built by the command's own function."""
    folder = tmp_path_factory.mktemp("library ü") / "assets"
    assets.build(folder)
    return folder


@pytest.fixture
def loaded(library, empty_file):
    """The library's assets, appended to an empty file, by name; returns bpy and them."""
    bpy = empty_file
    path = str(library / assets.BLEND)
    with bpy.data.libraries.load(path, assets_only=True) as (found, wanted):
        wanted.materials = found.materials
    return bpy, list(wanted.materials)


def test_every_preset_is_an_asset_with_its_values(loaded):
    from addon.material.node import material_node
    from addon.presets.apply import PRESET_KEY

    _, materials = loaded
    found = {material_node(material)[PRESET_KEY]: material for material in materials}
    assert set(found) == {preset.identifier for preset in presets.presets()}
    for preset in presets.presets():
        material = found[preset.identifier]
        assert material.name.startswith(preset.name)
        data = material.asset_data
        assert preset.source.title in data.description
        assert preset.source.url in data.description
        assert {tag.name for tag in data.tags} >= set(preset.tags)
        assert data.author
        assert preset.source.licence in data.license
        assert data.catalog_id == assets.catalogue_id(preset.kind)
        node = material_node(material)
        for identifier, value in preset.values.items():
            parameter = KINDS[preset.kind].by_identifier[identifier]
            socket = node.inputs[parameter.label].default_value
            assert (tuple(socket)[:3] if parameter.is_vector else socket) == pytest.approx(value)


def test_previews_are_the_pictures_the_right_way_up(loaded):
    from addon.material.node import material_node
    from addon.presets.apply import PRESET_KEY
    from addon.presets.icons import picture_path

    bpy, materials = loaded
    for material in materials:
        preview = material.preview
        assert preview.is_image_custom, material.name
        width, height = preview.image_size
        pixels = np.empty(width * height * 4, dtype=np.float32)
        preview.image_pixels_float.foreach_get(pixels)
        image = bpy.data.images.load(str(picture_path(material_node(material)[PRESET_KEY])))
        wanted = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(wanted)
        bpy.data.images.remove(image)
        assert np.abs(pixels - wanted).max() < 2 / 255, material.name


def test_the_library_has_a_group_a_kind_and_nothing_of_this_machine(loaded):
    bpy, _ = loaded
    assert len(bpy.data.node_groups) == len(KINDS)
    assert not bpy.data.images
    assert not bpy.data.objects
    assert not any(text.filepath for text in bpy.data.texts)


def test_catalogue_file(library):
    text = (library / assets.CATALOGUE_FILE).read_text(encoding="utf-8")
    version, *lines = [line for line in text.splitlines() if line]
    assert version == "VERSION 1"
    entries = [line.split(":") for line in lines]
    assert {path for _, path, _ in entries} == set(assets.CATALOGUES.values())
    assert all(path.startswith("Microbounce/") for _, path, _ in entries)
    assert len({uuid.UUID(identifier) for identifier, _, _ in entries}) == len(KINDS)
    assert "Microbounce/Metals" in text


def test_packing_harder_keeps_every_byte(tmp_path):
    content = b"BLENDER" + bytes(range(256)) * 10_000  # more than two frames
    path = tmp_path / "copy.blend"
    path.write_bytes(zstandard.compress(content))
    repack(path)
    with path.open("rb") as file:
        reader = zstandard.ZstdDecompressor().stream_reader(file, read_across_frames=True)
        assert reader.read() == content
    path.write_bytes(b"BLENDER-v405")
    with pytest.raises(zstandard.ZstdError):
        repack(path)


def test_a_library_of_other_sources_is_not_current(library, monkeypatch, tmp_path):
    assert assets.is_current(library)
    assert not assets.is_current(tmp_path)
    monkeypatch.setattr(assets, "digest", lambda: "other")
    assert not assets.is_current(library)


def test_a_missing_picture_is_named(empty_file, monkeypatch, tmp_path):
    from addon.presets import icons as preset_icons

    monkeypatch.setattr(preset_icons, "FOLDER", tmp_path)
    with pytest.raises(RuntimeError, match=r"\.webp is missing: render it with `make previews`"):
        assets.build(tmp_path / "assets")
    assert not assets.is_current(tmp_path / "assets")


def test_the_zip_holds_it(library, tmp_path):
    folder = tmp_path / "staged"
    folder.mkdir()
    extension.stage(folder, library)
    staged = {path.name for path in (folder / "assets").iterdir()}
    assert staged == {assets.BLEND, assets.CATALOGUE_FILE}
    # Nothing else in the zip is large.
    assert (folder / "assets" / assets.BLEND).stat().st_size < 3_000_000


@pytest.fixture
def offered(registered, monkeypatch, tmp_path):
    """A library that the extension offers, and one of the user's; returns bpy and the folder."""
    from addon.operators import library as ops

    folder = tmp_path / "assets"
    folder.mkdir()
    (folder / ops.BLEND).write_bytes(b"")
    monkeypatch.setattr(ops, "_FOLDERS", (folder,))
    libraries = registered.context.preferences.filepaths.asset_libraries
    before = [(item.name, item.path) for item in libraries]
    yield registered, folder
    assert [(item.name, item.path) for item in libraries] == before, "others are left alone"


def test_register_and_unregister(offered):
    bpy, folder = offered
    ops = bpy.ops.microbounce
    libraries = bpy.context.preferences.filepaths.asset_libraries
    assert not ops.unregister_library.poll()
    with pytest.raises(RuntimeError, match="is not in the preferences"):
        ops.unregister_library()
    assert ops.register_library() == {"FINISHED"}
    assert [(item.name, item.path) for item in libraries][-1] == ("Microbounce", str(folder))
    with pytest.raises(RuntimeError, match="is in the preferences already"):
        ops.register_library()
    assert ops.unregister_library() == {"FINISHED"}


def test_one_of_the_same_name_stays(offered):
    bpy, _ = offered
    libraries = bpy.context.preferences.filepaths.asset_libraries
    users = libraries.new(name="Microbounce", directory="/somewhere/else")
    ops = bpy.ops.microbounce
    ops.register_library()
    ops.unregister_library()
    assert (users.name, users.path) == ("Microbounce", "/somewhere/else")
    libraries.remove(users)


def test_a_folder_that_went_missing(offered):
    bpy, folder = offered
    ops = bpy.ops.microbounce
    ops.register_library()
    (folder / assets.BLEND).unlink()
    folder.rmdir()
    with pytest.raises(RuntimeError, match="has no asset library: install one that has"):
        ops.register_library()
    assert ops.unregister_library() == {"FINISHED"}, "an entry that leads nowhere can be removed"


def test_the_folder_of_the_preferences_goes_before_the_extensions_own(offered, stored, tmp_path):
    bpy, _ = offered
    ops = bpy.ops.microbounce
    libraries = bpy.context.preferences.filepaths.asset_libraries
    shared = tmp_path / "shared ü"
    stored.library_path = str(shared)
    with pytest.raises(RuntimeError, match=r"There is no microbounce\.blend in .*shared ü: choose"):
        ops.register_library()
    shared.mkdir()
    (shared / assets.BLEND).write_bytes(b"")
    assert not ops.register_library.poll(), "panels remember the answer"
    stored.library_path = ""
    ops.register_library.poll()
    stored.library_path = str(shared)
    ops.register_library()
    assert [item.path for item in libraries][-1] == str(shared)
    stored.library_path = ""  # the entry is still known as ours
    assert ops.unregister_library() == {"FINISHED"}


def test_the_disk_is_looked_at_when_something_changed(offered, stored, monkeypatch, tmp_path):
    from addon.operators import library as ops

    bpy, folder = offered
    libraries = bpy.context.preferences.filepaths.asset_libraries
    looked = []
    is_file = Path.is_file
    monkeypatch.setattr(Path, "is_file", lambda path: looked.append(path) or is_file(path))

    def looks():
        looked.clear()
        for _ in range(3):
            ops.registered_libraries(bpy.context)
            bpy.ops.microbounce.register_library.poll()
        return len(looked)

    assert looks()
    assert looks() == 0
    stored.library_path = str(tmp_path)
    assert looks()
    item = libraries.new(name="Other", directory=str(tmp_path))
    assert looks()
    assert looks() == 0
    libraries.remove(item)
    stored.library_path = ""
    assert looks()
    (folder / ops.BLEND).unlink()
    with pytest.raises(RuntimeError, match="has no asset library"):
        bpy.ops.microbounce.register_library()


def test_library_and_operators_agree_on_the_file_name():
    from addon.operators import library as ops

    assert ops.BLEND == assets.BLEND
    assert ops._FOLDERS[1] == assets.FOLDER
