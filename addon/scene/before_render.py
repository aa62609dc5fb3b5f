# SPDX-License-Identifier: GPL-3.0-or-later
"""The check before rendering: what keeps our materials in a scene from looking as they should.

It changes nothing, and is quick because it runs before each render.
"""

import bpy

from ..core.finding import Finding, by_level
from ..core.lamps import exact_warning
from ..material.graph import our_nodes, surface_tree
from ..material.group import GROUP_ERRORS, script_node
from ..material.versions import is_newer, is_of_another_version
from .exact import enabled_lamps, is_exact
from .rendered import rendered_materials
from .status import scene_status

_MISSING = "The library file of its node group is missing: it renders black."
_FIND = "Use File > External Data > Find Missing Files, or put the library back."
_NO_SCRIPT = "The script node in its node group is gone; Cycles' own material shows."
_REPLACE = "Add a material of the same kind, and use its node group instead."
_HASH_ALONE = "Its shader's bytecode was taken out, but not the hash: Blender 5.2 stops on that."
_NO_BYTECODE = "Its shader is not compiled; Cycles' own material shows."
_MEND = "Add a material of the same kind in a Blender with Open Shading Language, which mends it."
_MEND_LIBRARY = "Open the library file, add a material of the same kind there, and save."
_NO_TEXT = "The text of its shader was deleted; the compiled shader still renders."
_OTHER = "Another version of Microbounce made it, and it renders as that version did."
_UPGRADE = "Install that newer version to change it."
_UPDATE = "Use Update Materials to give it today's shader."
_UPDATE_LIBRARY = "Use Update Materials in the library file, and save that."

# The findings of the last check, by the scene's number in this session.
_last: dict[int, tuple[Finding, ...]] = {}


def check_scene(
    scene: bpy.types.Scene, preferences: bpy.types.Preferences
) -> tuple[Finding, ...] | None:
    """Return what the user should know before `scene` is rendered, the worst first.

    Returns None if no material of ours is rendered.
    """
    users: dict[bpy.types.NodeTree, list[bpy.types.Material]] = {}
    ours: list[bpy.types.Material] = []
    exact: list[bpy.types.Material] = []
    for material in rendered_materials(scene):
        tree = surface_tree(material)
        nodes = list(our_nodes(tree)) if tree is not None else []
        for group in {node.node_tree for node in nodes}:
            users.setdefault(group, []).append(material)
        if nodes:
            ours.append(material)
        if any(map(is_exact, nodes)):
            exact.append(material)
    if not users:
        return None
    found = _scene_findings(scene, preferences)
    if exact and not found:  # without the shaders, Cycles' own material finds every light
        found = _lights_findings(scene, exact)
    for group, materials in users.items():
        found += _group_findings(group, materials)
    return by_level(found + _image_findings(ours))


def remember(scene: bpy.types.Scene, findings: tuple[Finding, ...]) -> bool:
    """Keep the findings for the panels; return whether they differ from the last ones."""
    changed = _last.get(scene.session_uid) != findings
    _last[scene.session_uid] = findings
    return changed


def last_render_findings(scene: bpy.types.Scene) -> tuple[Finding, ...] | None:
    """Return what the last check of `scene` found, None if there was none."""
    return _last.get(scene.session_uid)


def forget(scene: bpy.types.Scene) -> None:
    """Drop the findings of `scene`."""
    _last.pop(scene.session_uid, None)


def forget_all() -> None:
    """Drop the findings of all scenes."""
    _last.clear()


def _scene_findings(scene: bpy.types.Scene, preferences: bpy.types.Preferences) -> list[Finding]:
    status = scene_status(scene, preferences)
    if status.ok:
        return []
    return [Finding("warning", f"Scene '{scene.name}'", status.reason, status.remedy)]


def _lights_findings(scene: bpy.types.Scene, exact: list[bpy.types.Material]) -> list[Finding]:
    lamps = {
        lamp: None for layer in scene.view_layers if layer.use for lamp in enabled_lamps(layer)
    }
    warning = exact_warning(lamps)
    return [Finding("warning", _named(exact), warning)] if warning else []


def _group_findings(
    group: bpy.types.NodeTree, materials: list[bpy.types.Material]
) -> list[Finding]:
    """Return what is wrong with one of our groups; `materials` are those that have it."""
    subject, linked = _named(materials), group.library is not None
    if group.is_missing:
        return [Finding("error", subject, _MISSING, _FIND)]
    findings = []
    mend = _MEND_LIBRARY if linked else _MEND
    script = script_node(group)
    if script is None:
        findings.append(Finding("warning", subject, _NO_SCRIPT, _REPLACE))
    elif not script.bytecode and script.bytecode_hash:
        findings.append(Finding("error", subject, _HASH_ALONE, mend))
    elif not script.bytecode_hash:  # Cycles goes by the hash
        findings.append(Finding("warning", subject, _NO_BYTECODE, mend))
    elif script.script is None and script.mode == "INTERNAL":
        findings.append(Finding("note", subject, _NO_TEXT, mend))
    try:
        other, newer = is_of_another_version(group), is_newer(group)
    except GROUP_ERRORS as error:  # a damaged installation; the file itself still renders
        return [*findings, Finding("note", subject, f"{error}.")]
    if other:
        older = _UPDATE_LIBRARY if linked else _UPDATE
        findings.append(Finding("note", subject, _OTHER, _UPGRADE if newer else older))
    return findings


def _image_findings(materials: list[bpy.types.Material]) -> list[Finding]:
    # Imported here, so that the extension starts sooner.
    from .image_files import images_in, missing_image
    from .usage import material_use

    found = (missing_image(*item) for item in images_in(map(material_use, materials)).items())
    return [finding for finding in found if finding is not None]


def _named(materials: list[bpy.types.Material]) -> str:
    first, others = materials[0], len(materials) - 1
    return f"Material '{first.name}'" + (f" and {others} more" if others else "")
