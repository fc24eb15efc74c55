# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that end Framelet's modifiers, and the one that takes the mask of Sculpt Mode for theirs."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from .mesh_io import mesh_bridge
from .mesh_io.own_names import kind_refusal
from .mesh_io.typed_attributes import typed_attribute
from .modifier.attributes import read_numbers, write_numbers
from .modifier.inputs import set_input
from .modifier.node_groups import MASK
from .modifier.offsets import KINDS, apply_modifier, has_modifier, remove_modifier
from .modifier.recipes import DISPLACEMENT, EQUALIZER
from .modifier.stack import find_modifier
from .preview import targets

SCULPT_MASK = ".sculpt_mask"
COPIED_MASK = "framelet_mask"


class KindMixin:
    """Which modifier is meant."""

    kind: bpy.props.EnumProperty(
        name="Modifier",
        description="Which modifier of Framelet",
        items=[
            (DISPLACEMENT, "Denoise", "What denoising moved"),
            (EQUALIZER, "Equalizer", "The scales of the mesh"),
        ],
        options=set(),
    )


def _poll_reason(context: bpy.types.Context) -> str | None:
    """Say why there is no modifier to work on; None if there is one."""
    reason = targets.poll_reason(context)
    if reason is None and not any(map(has_modifier, targets.target_objects(context))):
        return n_("The selected meshes have no modifier of Framelet")
    return reason


class OBJECT_OT_framelet_apply_modifier(KindMixin, bpy.types.Operator):
    """Move the vertices to where the modifier shows them, and remove it"""

    bl_idname = "object.framelet_apply_modifier"
    bl_label = "Apply Framelet Modifier"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with the modifier."""
        return targets.allows(cls, _poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply it on every target."""
        done = targets.run_on_targets(self, context, lambda obj, _progress: apply_modifier(obj, self.kind))
        if not done:
            return {"CANCELLED"}
        text = rpt_("Applied the modifier of {names}")
        self.report({"INFO"}, text.format(names=targets.names_text(list(done))))
        return {"FINISHED"}


class OBJECT_OT_framelet_remove_modifier(KindMixin, bpy.types.Operator):
    """Remove the modifier and what it needs: the mesh is as it was before"""

    bl_idname = "object.framelet_remove_modifier"
    bl_label = "Remove Framelet Modifier"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with the modifier."""
        return targets.allows(cls, _poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it from every target."""
        done = targets.run_on_targets(self, context, lambda obj, _progress: remove_modifier(obj, self.kind))
        if not done:
            return {"CANCELLED"}
        text = rpt_("Removed the modifier of {names}")
        self.report({"INFO"}, text.format(names=targets.names_text(list(done))))
        return {"FINISHED"}


class OBJECT_OT_framelet_sculpt_mask(bpy.types.Operator):
    """Have the modifiers leave alone what the mask of Sculpt Mode protects. Press again after painting"""

    # Nodes cannot read that mask, so that it is copied.

    bl_idname = "object.framelet_sculpt_mask"
    bl_label = "Mask from Sculpt Mask"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with a mask and a modifier, in Object Mode."""
        reason = targets.poll_reason(context, in_object_mode=True) or _poll_reason(context)
        if reason is None and not any(map(has_sculpt_mask, targets.target_objects(context))):
            reason = n_("The selected meshes have no mask of Sculpt Mode")
        return targets.allows(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy the mask of every target."""
        done = targets.run_on_targets(self, context, lambda obj, _progress: take_sculpt_mask(obj))
        return {"FINISHED"} if done else {"CANCELLED"}


def has_sculpt_mask(obj: bpy.types.Object) -> bool:
    """Tell whether a mesh has a mask of Sculpt Mode."""
    return typed_attribute(obj.data, SCULPT_MASK, "FLOAT", "POINT") is not None


def take_sculpt_mask(obj: bpy.types.Object) -> None:
    """Copy the mask of Sculpt Mode, and let the modifiers of an object take it.

    Raises
    ------
    ValueError
        With a sentence that names the object, if its mesh has none or cannot be written to.
    """
    reason = mesh_bridge.ownership_refusal(obj)
    if reason is None and not has_sculpt_mask(obj):
        reason = f"‘{obj.name}’ has no mask of Sculpt Mode; paint one, or choose a vertex group."
    if reason is None and COPIED_MASK in obj.vertex_groups:
        reason = f"The vertex group {COPIED_MASK} of ‘{obj.name}’ is in the way of the copy; rename it."
    reason = reason or kind_refusal(obj, COPIED_MASK)
    if reason is not None:
        raise ValueError(reason)
    write_numbers(obj.data, COPIED_MASK, 1.0 - read_numbers(obj, SCULPT_MASK))
    for kind in KINDS:
        modifier = find_modifier(obj, kind)
        if modifier is not None:
            set_input(modifier, MASK, COPIED_MASK)


classes = (
    OBJECT_OT_framelet_apply_modifier,
    OBJECT_OT_framelet_remove_modifier,
    OBJECT_OT_framelet_sculpt_mask,
)
