# SPDX-License-Identifier: GPL-3.0-or-later
"""Register, unregister, register: nothing stays behind, nothing is lost."""

import re

from blender_tests.addon.support import ROOT, run_blender

STATE = """
import addon

def state():
    handlers = {
        name: len(found)
        for name in dir(bpy.app.handlers)
        if isinstance(found := getattr(bpy.app.handlers, name), list)
    }
    classes = sorted(name for name in dir(bpy.types) if "microbounce" in name.lower())
    operators = sorted(dir(bpy.ops.microbounce))
    menu = [f.__name__ for f in bpy.types.NODE_MT_shader_node_add_all._dyn_ui_initialize()]
    properties = sorted(
        f"{owner}.{key}"
        for owner in ("Scene", "Material", "Object", "WindowManager", "ShaderNodeTree")
        for key in getattr(bpy.types, owner).bl_rna.properties.keys()
    )
    return [handlers, classes, operators, menu, properties]

bpy.types.NODE_MT_shader_node_add_all._dyn_ui_initialize()
"""


def test_register_unregister_register(tmp_path):
    script = (
        STATE
        + """
states = [state()]
for step in (addon.register, addon.unregister, addon.register, addon.unregister):
    step()
    states.append(state())
finish(states)
"""
    )
    clean, first, between, second, after = run_blender(script, tmp_path)
    assert between == clean
    assert after == clean
    assert second == first
    one_more = clean[0] | {"render_init": clean[0]["render_init"] + 1}
    assert first[0] == one_more, "the check before rendering is the one handler"
    assert {"MICROBOUNCE_MT_add", "MICROBOUNCE_PT_material", "MICROBOUNCE_PT_shader_editor"} <= set(
        first[1]
    )
    written = "".join(path.read_text("utf-8") for path in (ROOT / "addon").rglob("*.py"))
    assert first[2] == sorted(re.findall(r'bl_idname = "microbounce\.(\w+)"', written))
    assert set(first[3]) - set(clean[3]) == {"draw_add_menu"}


def test_a_failed_registration_leaves_nothing(tmp_path):
    script = (
        STATE
        + """
import types
import addon.registration as registration

class Broken(bpy.types.Operator):
    bl_idname = "not an identifier"
    bl_label = "Broken"

before = state()
registration._MODULES = (*registration._MODULES, types.SimpleNamespace(CLASSES=(Broken,)))
try:
    addon.register()
    message = ""
except Exception as error:
    message = str(error)
finish([before, state(), message])
"""
    )
    before, after, message = run_blender(script, tmp_path)
    assert "Broken" in message
    assert after == before
