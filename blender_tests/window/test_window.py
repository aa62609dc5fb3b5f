# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip in a real Blender's window: installed, drawn, used, rendered with EEVEE, removed."""

import numpy as np
import pytest

from tools.window.session import run_session


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """The result of one session, which takes about 25 seconds."""
    return run_session(tmp_path_factory.mktemp("session"))


def test_it_comes_to_its_end_without_an_error(session):
    assert session["errors"] == []
    assert session["done"]
    assert "Traceback" not in session["printed"]
    assert "RuntimeWarning" not in session["printed"]
    assert "bpy.rna" not in session["printed"]
    lines = session["printed"].splitlines()
    # Blender's own message when it quits.
    own = ("Error: Not freed memory",)
    assert [line for line in lines if "Error" in line and not line.startswith(own)] == []


def test_it_is_installed_and_taken_out(session):
    assert session["installed"] == ["bl_ext.user_default.microbounce"]
    assert session["left"] == []


def test_every_panel_is_drawn(session):
    assert {"MICROBOUNCE_PT_material", "MICROBOUNCE_PT_shader_editor"} <= set(session["panels"])
    assert sorted(session["drawn"]) == session["panels"]


def test_the_buttons_work(session):
    ran = session["ran"]
    expected = {"add_material", "apply_preset", "analyse", "check_farm", "check_render"}
    assert expected | {"to_native", "to_microbounce"} <= set(ran)
    assert all(done == ["FINISHED"] for done in ran.values()), ran


def test_presets_are_applied_by_the_button_and_by_typing(session):
    states = session["states"]
    assert "ShaderNodeGroup" in states["added"]["nodes"].values()
    assert states["added"]["presets"] == []
    assert states["preset"]["presets"] == ["conductor/gold"]
    assert states["searched"]["presets"] == ["conductor/copper"]


def test_conversion_is_taken_back_by_the_keyboard(session):
    kinds = {
        name: set(state["nodes"].values()) - {"ShaderNodeOutputMaterial"}
        for name, state in session["states"].items()
    }
    assert kinds["to_native"] == {"ShaderNodeBsdfMetallic"}
    assert kinds["to_microbounce"] == {"ShaderNodeGroup"}
    assert kinds["undo1"] == kinds["to_native"]
    assert kinds["undo2"] == kinds["checked"] == {"ShaderNodeGroup"}


def test_eevee_shows_the_material_like_cycles_without_osl(session):
    eevee, cycles = (np.array(session["centres"][name]) for name in ("EEVEE", "CYCLES"))
    assert (cycles > 0.05).all(), "black"
    # The two light a rough metal differently. The measured difference is within a per cent.
    assert np.abs(eevee / cycles - 1.0).max() < 0.1
