# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that a farm can render, to be damaged by tests, and what the check finds in one."""

import bpy

from addon.core.finding import Finding
from addon.core.kinds import KINDS
from blender_tests.addon.support import small_scene


class OurScene:
    """A clean scene of one sphere with one material, and what the tests damage in it."""

    def __init__(self, kind: str) -> None:
        from addon.material.group import script_node
        from addon.material.node import new_material

        self.scene, self.sphere = small_scene(osl=True)
        self.material = new_material(kind, "Ours")
        self.sphere.data.materials.append(self.material)
        self.group = bpy.data.node_groups[KINDS[kind].name]
        self.script = script_node(self.group)


def findings(scene: bpy.types.Scene) -> list[Finding]:
    """Return what the check finds in the file, `scene` being the one to render."""
    from addon.farm.check import farm_findings

    return farm_findings(scene)


def the_finding(scene: bpy.types.Scene) -> tuple[str, str, str]:
    """Return the one finding as level, subject and message; it has to have a remedy."""
    (found,) = findings(scene)
    assert found.remedy
    return found.level, found.subject, found.message
