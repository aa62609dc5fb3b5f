# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own Python can import `oslquery`, and there Cycles fills the script node by itself."""

from addon.core.kinds import KINDS
from blender_tests.addon.support import run_blender

# The bundled packages of a wheel are those of the application; a wheel just leaves them aside.
SCRIPT = """
import importlib.util
from pathlib import Path

if {bundled}:
    scripts = Path(importlib.util.find_spec("cycles").origin).parents[2]
    (packages,) = (scripts.parent / "python" / "lib").glob("python*/site-packages")
    sys.path.insert(0, str(packages))
    import OpenImageIO, oslquery
bpy.context.scene.render.engine = "CYCLES"
from addon.material.group import material_group

def sockets(collection):
    return [[s.identifier, s.name, s.bl_idname, s.is_linked] for s in collection]

def described(kind):
    (node,) = [n for n in material_group(kind).nodes if n.bl_idname == "ShaderNodeScript"]
    return [sockets(node.inputs), sockets(node.outputs), node.bytecode_hash, len(node.bytecode)]

finish({{kind: described(kind) for kind in {kinds!r}}})
"""


def test_script_nodes_are_the_same_with_and_without_oslquery(tmp_path):
    with_it = run_blender(SCRIPT.format(kinds=list(KINDS), bundled=True), tmp_path)
    without = run_blender(SCRIPT.format(kinds=list(KINDS), bundled=False), tmp_path)
    assert with_it == without
    for kind, (inputs, outputs, *_) in with_it.items():
        assert [socket[0] for socket in inputs] == [p.identifier for p in KINDS[kind].parameters]
        assert all(socket[3] for socket in inputs + outputs)
