# SPDX-License-Identifier: GPL-3.0-or-later
"""The check for a farm: every defect gives its own finding, a clean file none."""

import pytest

from blender_tests.addon.support import small_scene


@pytest.fixture
def scene(registered, kind):
    """A clean scene with a sphere of each kind of material in turn."""
    from addon.nodes.group import new_material

    scene, sphere = small_scene(osl=True)
    sphere.data.materials.append(new_material(kind, "Ours"))
    return scene


def findings(scene):
    from addon.nodes.farm.check import farm_findings

    return farm_findings(scene)


def test_a_clean_file_has_no_finding(scene):
    assert findings(scene) == []
