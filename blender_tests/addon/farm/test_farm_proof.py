# SPDX-License-Identifier: GPL-3.0-or-later
"""The proof by rendering: the same picture without the extension, and what stands in its way."""

import os
import time

import numpy as np
import OpenImageIO
import pytest

from addon.farm.proof import TOLERANCE, Proof, ProofError, prove
from addon.farm.small_render import SIZE, pixels
from blender_tests.addon.support import small_scene


@pytest.fixture
def saved(registered, tmp_path):
    """Saves a scene of one rough metal; a function that damages it may be given."""
    from addon.material.group import material_group, script_node
    from addon.material.node import new_material

    def save(damage=lambda script: None):
        _, sphere = small_scene(osl=True)
        sphere.data.materials.append(new_material("CONDUCTOR", "Ours", Roughness=0.9))
        damage(script_node(material_group("CONDUCTOR")))
        path = tmp_path / "scene.blend"
        registered.ops.wm.save_as_mainfile(filepath=str(path))
        return path

    return save


def test_a_clean_file_renders_the_same_alone(saved, registered):
    told = []
    path = saved()
    registered.data.texts.new("not saved")
    proof = prove(path, tell=told.append)
    assert proof.ok
    assert proof.difference == 0.0, "a faceted mesh gives the same bits"
    assert proof.brightness > 0.05
    assert proof.findings(path) == []
    assert [progress.text for progress in told] == [
        "Rendering with the extension (1 of 2)",
        "Rendering without the extension (2 of 2)",
    ]
    assert [progress.part for progress in told] == [0.0, 0.5]
    assert sorted(os.listdir(path.parent)) == ["scene.blend"], "nothing is left beside the file"
    assert "not saved" in registered.data.texts, "the open file is left alone"
    assert registered.context.scene.render.resolution_x != SIZE


def test_the_bytecode_of_another_shader_is_seen(saved):
    from addon.material.group import material_group, script_node
    from addon.material.script import set_bytecode

    path = saved(
        lambda script: set_bytecode(script, script_node(material_group("DIFFUSE")).bytecode)
    )
    proof = prove(path)
    assert not proof.ok
    (found,) = proof.findings(path)
    assert found.level == "error"
    assert "renders differently" in found.message


def test_a_render_that_takes_too_long_is_ended(saved):
    path = saved()
    start = time.monotonic()
    with pytest.raises(ProofError, match=r"with the extension took longer than 0\.2 seconds"):
        prove(path, time_limit=0.2)
    assert time.monotonic() - start < 10


def test_a_scene_that_cannot_be_rendered_says_why(saved, registered):
    path = saved()
    registered.context.scene.camera = None
    for obj in [o for o in registered.data.objects if o.type == "CAMERA"]:
        registered.data.objects.remove(obj)
    registered.ops.wm.save_mainfile()
    with pytest.raises(ProofError, match=r"with the extension failed: .*camera"):
        prove(path)
    path.write_bytes(b"no such file")
    with pytest.raises(ProofError, match="failed"):
        prove(path)


@pytest.mark.parametrize(
    ("difference", "brightness", "level"),
    [
        (0.0, 0.0, "warning"),
        (0.0, float("nan"), "warning"),
        (TOLERANCE / 2, 1.0, "note"),
        (TOLERANCE * 1.01, 1.0, "error"),
    ],
)
def test_what_a_proof_finds(tmp_path, difference, brightness, level):
    proof = Proof(difference, brightness, 1.0)
    (found,) = proof.findings(tmp_path / "a.blend")
    assert (found.level, found.subject) == (level, "File 'a.blend'")
    assert proof.ok == (level == "note")


def test_pixels_of_a_picture(registered, tmp_path):
    path = str(tmp_path / "picture.exr")
    rows = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    output = OpenImageIO.ImageOutput.create(path)
    output.open(path, OpenImageIO.ImageSpec(3, 2, 4, OpenImageIO.FLOAT))
    output.write_image(rows)
    output.close()
    assert np.array_equal(pixels(path), rows[::-1].ravel()), "Blender's rows go upwards"
