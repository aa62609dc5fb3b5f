# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip: its contents, its installation, and files that render without it."""

import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pytest

from addon.core import VERSION
from addon.core.kinds import KINDS
from blender_tests.addon.support import ROOT, read_picture, run_blender
from tools.release import extension


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    """The zip, built by the same command as `make addon` but elsewhere."""
    folder = tmp_path_factory.mktemp("zip")
    done = subprocess.run(
        [
            sys.executable,
            *("-m", "tools.release.extension"),
            *("--output", str(folder / "dist"), "--work", str(folder / "build")),
            *("--library", str(folder / "none")),
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = (folder / "dist").iterdir()
    return path


def test_zip_holds_the_extension_and_nothing_else(archive):
    names = set(zipfile.ZipFile(archive).namelist())
    expected = {"LICENSE"}
    for path in (ROOT / "addon").rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            expected.add(path.relative_to(ROOT / "addon").as_posix())
    shaders = [*(ROOT / "osl").glob("*.osl"), *(ROOT / "osl").rglob("*.h")]
    expected |= {path.relative_to(ROOT).as_posix() for path in shaders}
    assert names == expected
    assert {f"osl/{kind.shader}.osl" for kind in KINDS.values()} <= names
    assert "blender_manifest.toml" in names


def test_zip_holds_no_path_of_this_machine_and_no_byte_code(archive):
    with zipfile.ZipFile(archive) as packed:
        for name in packed.namelist():
            assert not name.endswith((".pyc", ".oso"))
            content = packed.read(name)
            for folder in (ROOT, tempfile.gettempdir(), Path.home()):
                assert f"{folder}/".encode() not in content, name
            if not name.endswith(".webp"):
                content.decode("utf-8")


def test_a_damaged_manifest_is_refused(tmp_path):
    folder = tmp_path / "broken"
    folder.mkdir()
    extension.stage(folder)
    manifest = folder / "blender_manifest.toml"
    text = manifest.read_text(encoding="utf-8")
    manifest.write_text(text.replace('"add-on"', '"gadget"'), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(extension.builder_script()), "validate", str(folder)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0


INSTALL = """
from blender_tests.addon.support import small_scene
installed = bpy.ops.extensions.package_install_files(
    filepath={archive!r}, repo="user_default", enable_on_install=True
)
name = "bl_ext.user_default.microbounce"
"""

MAKE = (
    INSTALL
    + """
scene, sphere = small_scene(osl=True)
bpy.ops.preferences.addon_enable(module=name)  # the factory settings switched it off
sphere.data.materials.clear()
bpy.ops.microbounce.add_material(kind={kind!r})
node = next(n for n in sphere.active_material.node_tree.nodes if n.type == "GROUP")
node.inputs["Roughness"].default_value = 0.8
node.inputs["Anisotropy"].default_value = {anisotropy}
scene.render.filepath = {exr!r}
bpy.ops.render.render(write_still=True)
bpy.ops.wm.save_as_mainfile(filepath={blend!r})
import addon_utils
finish({{
    "installed": list(installed),
    "loaded": addon_utils.check(name),
    "from": sys.modules[name].__file__,
    "bytecode": any(n.type == "SCRIPT" and n.bytecode for n in node.node_tree.nodes),
}})
"""
)

RENDER = """
bpy.ops.wm.open_mainfile(filepath={blend!r})
bpy.context.scene.render.filepath = {exr!r}
bpy.ops.render.render(write_still=True)
finish({{
    "addons": [addon.module for addon in bpy.context.preferences.addons],
    "modules": [name for name in sys.modules if "microbounce" in name or name == "addon"],
    "operator": "add_material" in dir(bpy.ops.microbounce),
}})
"""


@pytest.mark.parametrize(
    ("kind", "anisotropy"),
    [("CONDUCTOR", 0.0), ("CONDUCTOR", 0.9), ("DIELECTRIC", 0.5), ("DIFFUSE", 0.5)],
)
def test_file_made_with_the_installed_zip_renders_the_same_without_it(
    archive, tmp_path, kind, anisotropy
):
    blend = str(tmp_path / "metal.blend")
    with_it, without = tmp_path / "with.exr", tmp_path / "without.exr"
    made = run_blender(
        MAKE.format(
            archive=str(archive), exr=str(with_it), blend=blend, kind=kind, anisotropy=anisotropy
        ),
        tmp_path,
    )
    assert made["installed"] == ["FINISHED"]
    assert made["loaded"] == [True, True]
    assert str(tmp_path) in made["from"], "it runs from the private folder"
    assert made["bytecode"]

    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    script = RENDER.format(blend=blend, exr=str(without))
    rendered = run_blender(script, elsewhere, modules=False)
    assert not any("microbounce" in module for module in rendered["addons"])
    assert rendered["modules"] == []
    assert not rendered["operator"]

    picture = read_picture(with_it)
    assert picture.max() > 0.1, "the picture is black"
    assert np.isfinite(picture).all()
    assert np.array_equal(picture, read_picture(without))


def test_installed_shader_that_is_missing_gives_the_error(archive, tmp_path, kind):
    script = (
        INSTALL
        + """
from pathlib import Path
folder = Path(sys.modules[name].__file__).parent
(folder / "osl" / "{shader}.osl").unlink()
bpy.ops.mesh.primitive_cube_add()
before = len(bpy.data.materials), len(bpy.data.texts), len(bpy.data.node_groups)
try:
    bpy.ops.microbounce.add_material(kind={kind!r})
    message = ""
except RuntimeError as error:
    message = str(error)
after = len(bpy.data.materials), len(bpy.data.texts), len(bpy.data.node_groups)
finish({{"message": message, "folder": str(folder), "before": before, "after": after}})
"""
    )
    result = run_blender(
        script.format(archive=str(archive), kind=kind, shader=KINDS[kind].shader), tmp_path
    )
    assert result["folder"] in result["message"]
    assert f"{KINDS[kind].shader}.osl is missing. Reinstall the extension" in result["message"]
    assert result["before"] == result["after"]


USE = (
    INSTALL
    + """
from pathlib import Path
from blender_tests.addon.installed import Installed, drawn_classes
made = Installed(name, Path({folder!r}))
made.use()
finish({{
    "ran": made.ran, "registered": dir(bpy.ops.microbounce),
    "drawn": sorted(made.drawn), "to draw": sorted(cls.__name__ for cls in drawn_classes()),
    "check": made.command("check"), "presets": made.command("presets"),
    "from the repository": "addon" in sys.modules,
}})
"""
)


def test_all_that_the_zip_registers_can_be_used(archive, tmp_path):
    result = run_blender(USE.format(archive=str(archive), folder=str(tmp_path)), tmp_path)
    assert sorted(result["ran"]) == sorted(result["registered"]), "none is left out"
    for name in ("to_native", "to_microbounce"):
        # A dry run leaves no step to undo: Blender has no other word for that.
        assert result["ran"].pop(name) == ["CANCELLED", "FINISHED"]
    assert {word for words in result["ran"].values() for word in words} == {"FINISHED"}
    assert result["drawn"] == result["to draw"] != []
    (code, checked), (listed, presets) = result["check"], result["presets"]
    assert (code, listed) == (0, 0), result
    assert checked["file"].endswith("smoke.blend")
    assert presets["presets"]
    assert not result["from the repository"]


UPGRADE = """
import importlib

name = "bl_ext.user_default.microbounce"

def install(archive):
    bpy.ops.extensions.package_install_files(
        filepath=archive, repo="user_default", enable_on_install=True
    )
    operator = bpy.ops.microbounce.add_material.get_rna_type()
    return [importlib.import_module(name + ".core").VERSION, operator.name]

states = [install(archive) for archive in {archives!r}]
bpy.ops.mesh.primitive_cube_add()
bpy.ops.microbounce.add_material(kind="CONDUCTOR")
node = next(n for n in bpy.context.object.active_material.node_tree.nodes if n.type == "GROUP")
bpy.ops.preferences.addon_disable(module=name)
left = [dir(bpy.ops.microbounce), [c for c in dir(bpy.types) if "MICROBOUNCE" in c]]
finish({{
    "states": states, "from": sys.modules[name].__file__, "left": left,
    "version": node.node_tree["microbounce_version"],
    "bytecode": any(n.type == "SCRIPT" and n.bytecode for n in node.node_tree.nodes),
}})
"""


def test_installed_again_and_upgraded_in_folders_with_any_name(archive, tmp_path):
    newer = tmp_path / "newer"
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(newer)
    for file, old, new in (
        ("blender_manifest.toml", f'version = "{VERSION}"', 'version = "99.0.0"'),
        ("core/__init__.py", f'VERSION = "{VERSION}"', 'VERSION = "99.0.0"'),
        ("operators/material.py", "Add Microbounce Material", "Add Newer Material"),
    ):
        text = (newer / file).read_text(encoding="utf-8")
        assert old in text
        (newer / file).write_text(text.replace(old, new), encoding="utf-8")
    upgrade = shutil.make_archive(str(tmp_path / "upgrade"), "zip", newer)

    folders = {key: tmp_path / f"{key} ü 空" for key in ("TMPDIR", "BLENDER_USER_RESOURCES")}
    for folder in folders.values():
        folder.mkdir()
    script = UPGRADE.format(archives=[str(archive), str(archive), upgrade])
    environment = {key: str(folder) for key, folder in folders.items()}
    result = run_blender(script, tmp_path, environment, modules=False)
    today = [VERSION, "Add Microbounce Material"]
    assert result["states"] == [today, today, ["99.0.0", "Add Newer Material"]]
    assert str(folders["BLENDER_USER_RESOURCES"]) in result["from"]
    assert result["version"] == "99.0.0"
    assert result["bytecode"]
    assert result["left"] == [[], []]
