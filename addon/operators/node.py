# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a node group in the Shader editor."""

import bpy

from ..core.kinds import KINDS
from ..material.group import GROUP_ERRORS, add_group_node, material_group
from ..preferences import preferences
from .kinds import KIND_ITEMS
from .osl import osl_status
from .polled import Polled


class MICROBOUNCE_OT_add_node(Polled, bpy.types.Operator):
    """Add a node group at the cursor of the Shader editor."""

    bl_idname = "microbounce.add_node"
    bl_label = "Add Microbounce Node"
    bl_description = "Add a material that keeps the light of several bounces on its microsurface"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", description="What it is made of", items=KIND_ITEMS)

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """Name the kind in the tooltip of a button."""
        surface = KINDS[properties.kind].surface.lower()
        return f"Add a {surface} that keeps the light of several bounces on its microsurface"

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why no node can be added here, with the remedy; "" if one can."""
        space = context.space_data
        if space is None or space.type != "NODE_EDITOR" or space.tree_type != "ShaderNodeTree":
            return "This works in the Shader editor: open one"
        if space.shader_type != "OBJECT":
            return "These materials are for objects: choose Object in the Shader editor's header"
        if space.edit_tree is None:
            return "There is no material here: press New in the Shader editor's header"
        if not space.edit_tree.is_editable:
            return f"'{space.edit_tree.name}' is linked from a library: make it local"
        return ""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Add the node under the pointer and let it follow until a click."""
        space = context.space_data
        if context.region.type == "WINDOW":
            space.cursor_location_from_region(event.mouse_region_x, event.mouse_region_y)
        else:
            space.cursor_location = space.edit_tree.view_center
        result = self.execute(context)
        if "FINISHED" in result:
            bpy.ops.node.translate_attach_remove_on_cancel("INVOKE_DEFAULT")
        return result

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the node at the editor's cursor, selected, and warn if it will not run."""
        space = context.space_data
        tree = space.edit_tree
        try:
            group = material_group(self.kind)
        except GROUP_ERRORS as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if group == tree or group.contains_tree(tree):
            self.report({"ERROR"}, "A node group cannot hold itself: leave the group first (Tab)")
            return {"CANCELLED"}
        for other in tree.nodes:
            other.select = False
        node = add_group_node(tree, group)
        quality = KINDS[self.kind].by_identifier["Quality"]
        value = quality.checked(preferences(context).quality)
        node.inputs[quality.label].default_value = value
        node.location = space.cursor_location
        node.select = True
        tree.nodes.active = node
        status = osl_status(context)
        if not status.ok:
            self.report({"WARNING"}, status.message)
        return {"FINISHED"}


CLASSES = (MICROBOUNCE_OT_add_node,)
