# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures of the extension's tests."""

from functools import cache

import pytest

from addon.core.kinds import KINDS


@pytest.fixture(params=list(KINDS))
def kind(request):
    """Each kind of material in turn, by its identifier."""
    return request.param


@pytest.fixture
def empty_file():
    """An empty file with factory settings; returns bpy."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy


@pytest.fixture
def registered(empty_file):
    """An empty file with the extension registered; returns bpy."""
    import addon

    addon.register()
    yield empty_file
    addon.unregister()


@pytest.fixture
def stored(registered):
    """The preferences as Blender keeps them for an extension that is enabled."""
    addons = registered.context.preferences.addons
    entry = addons.new()
    entry.module = "addon"
    yield entry.preferences
    addons.remove(addons["addon"])


@pytest.fixture
def command(registered, capfd):
    """Runs the command; returns its exit code, standard output and standard error."""
    from addon.command.main import main

    def run(*argv):
        capfd.readouterr()
        code = main([str(word) for word in argv])
        return code, *capfd.readouterr()

    return run


@pytest.fixture
def osl_scene(registered):
    """A scene of Cycles with OSL, a sphere and a light; the extension is registered."""
    from blender_tests.addon.support import small_scene

    scene, _ = small_scene(osl=True)
    return scene


@pytest.fixture
def metal(empty_file):
    """A metal, its node tree and our node in it."""
    from addon.material.node import new_material

    material = new_material("CONDUCTOR", "Metal")
    tree = material.node_tree
    return material, tree, next(n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup")


@pytest.fixture
def compiled_once(monkeypatch):
    """Compile each shader once for all tests that use this: none of them is about compiling."""
    from addon.material import group

    monkeypatch.setattr(group, "compile_source", _compiled)


@cache
def _compiled(source: str) -> str:
    from addon.material.script import compile_source

    return compile_source(source)
