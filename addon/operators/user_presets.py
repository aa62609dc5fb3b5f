# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves the values of a material's node as a user's preset, applies and removes such presets.

They lie in Blender's own preset folders, `presets/microbounce/<kind>`, and are parsed, never run.
"""

from functools import lru_cache, partial
from pathlib import Path

import bpy

from ..core.kinds import KINDS
from ..core.presets.files import PresetError
from ..core.presets.user_files import SUFFIX, load, preset_text, saved_parameters
from ..material.graph import node_kind
from ..material.node import material_node
from ..presets.user import user_presets
from .polled import Polled
from .presets import AppliesPreset, shown_material


def shown_name(path: Path) -> str:
    """Return the name in a preset's file, which may have letters that the file's name lacks.

    If the file cannot be read, it is the file's own name.
    """
    try:
        return _read_name(path, path.stat().st_mtime_ns)
    except (OSError, PresetError):
        return bpy.path.display_name(path.stem, title_case=False)


@lru_cache(maxsize=1024)  # menus are drawn often, and files change seldom
def _read_name(path: Path, changed: int) -> str:
    return load(path).name


def node_values(node: bpy.types.Node) -> dict[str, object]:
    """Return the values of one of our nodes by identifier, without those that are linked."""
    values = {}
    for parameter in saved_parameters(node_kind(node)):
        socket = node.inputs.get(parameter.label)
        if socket is not None and not socket.is_linked:
            value = socket.default_value
            values[parameter.identifier] = tuple(value)[:3] if parameter.is_vector else value
    return values


def save_user_preset(node: bpy.types.Node, name: str) -> Path:
    """Write the node's values into a new file of the user's presets and return its path.

    Raises PresetError for a bad name, a name that is taken, a value out of range, and a folder
    that cannot be written.
    """
    kind = node_kind(node)
    try:
        text = preset_text(kind, name, node_values(node))
    except (TypeError, ValueError) as error:
        raise PresetError(str(error)) from error
    folder = bpy.utils.user_resource("SCRIPTS", path=f"presets/microbounce/{kind.lower()}")
    path = Path(folder) / f"{bpy.path.clean_name(name.strip())}{SUFFIX}"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError as error:
        raise PresetError(
            f"There is a preset '{name}' already: choose another name, or remove it first"
        ) from error
    except OSError as error:
        raise PresetError(
            f"The preset cannot be written to {path} ({error}). Make the folder writable"
        ) from error
    return path


class MICROBOUNCE_OT_save_preset(Polled, bpy.types.Operator):
    """Save the values of the material's node as a preset."""

    bl_idname = "microbounce.save_preset"
    bl_label = "Save Microbounce Preset"
    bl_description = "Save the values of the material's Microbounce node as a preset of your own"
    bl_options = {"INTERNAL"}  # it writes a file, so there is nothing to undo

    name: bpy.props.StringProperty(name="Name", description="Name of the preset", maxlen=64)

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return that there is no node of ours; "" if there is one."""
        if material_node(shown_material(context)) is not None:
            return ""
        return "No Microbounce node feeds the material's output: add one"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the name and suggest the material's."""
        self.name = shown_material(context).name[:64]
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file."""
        try:
            path = save_user_preset(material_node(shown_material(context)), self.name)
        except PresetError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Saved {path}")
        return {"FINISHED"}


class MICROBOUNCE_OT_apply_user_preset(AppliesPreset, bpy.types.Operator):
    """Apply a preset that was saved."""

    bl_idname = "microbounce.apply_user_preset"
    bl_label = "Apply Saved Microbounce Preset"
    bl_description = "Give the material the values of this preset"

    filepath: bpy.props.StringProperty(
        name="File", description="The preset's file", subtype="FILE_PATH", options={"SKIP_SAVE"}
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Read the file and set its values."""
        return self.apply(context, partial(load, Path(bpy.path.abspath(self.filepath))))


class MICROBOUNCE_OT_remove_user_preset(bpy.types.Operator):
    """Delete the file of a preset that was saved."""

    bl_idname = "microbounce.remove_user_preset"
    bl_label = "Remove Saved Microbounce Preset"
    bl_description = "Delete the file of this preset"
    bl_options = {"INTERNAL"}  # it deletes a file, which undo would not bring back

    filepath: bpy.props.StringProperty(
        name="File", description="The preset's file", subtype="FILE_PATH", options={"SKIP_SAVE"}
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask first."""
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Delete the file, if it is one of the presets."""
        path = Path(self.filepath)
        if not any(path in user_presets(kind) for kind in KINDS):
            self.report(
                {"ERROR"}, f"{path} is not one of the saved presets: choose one from the menu"
            )
            return {"CANCELLED"}
        try:
            path.unlink()
        except OSError as error:
            self.report({"ERROR"}, f"{path} cannot be deleted ({error}): make it writable")
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (
    MICROBOUNCE_OT_save_preset,
    MICROBOUNCE_OT_apply_user_preset,
    MICROBOUNCE_OT_remove_user_preset,
)
