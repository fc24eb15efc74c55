# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that turn the live preview on and off and keep what it shows."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_

from .context_objects import active_object
from .preview import targets
from .preview.current_preview import current_preview, end_preview, is_too_large, start_preview
from .properties.own_settings import settings_of
from .run.current_run import IS_RUNNING, current_run
from .window_events import cancels


class OBJECT_OT_framelet_preview(bpy.types.Operator):
    """Show on the active mesh what the settings would give, while they are changed; Esc ends it"""

    bl_idname = "object.framelet_preview"
    bl_label = "Live Preview"
    # No undo step: nothing has changed for good.
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for an active mesh in Object Mode, unless the preview is on."""
        if current_preview() is not None:
            return True
        obj = active_object(context)
        reason = None
        if current_run() is not None:
            reason = IS_RUNNING
        elif obj is None or obj.type != "MESH":
            reason = n_("Make a mesh object active")
        elif context.mode != "OBJECT":
            reason = n_("Switch to Object Mode")
        elif is_too_large(obj):
            reason = n_("The mesh has too many vertices for a preview; press Denoise")
        return targets.allows(cls, reason)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Toggle, and wait for Esc while it is on."""
        found = self.execute(context)
        if current_preview() is None or bpy.app.background or context.window is None:
            return found
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """End with Esc in a 3D View or with the preview; everything else is Blender's."""
        session = current_preview()
        if session is None:
            return {"FINISHED", "PASS_THROUGH"}
        if event.type == "ESC" and cancels(context, event):
            end_preview()
            return {"FINISHED"}
        return {"PASS_THROUGH"}

    def cancel(self, _context: bpy.types.Context) -> None:
        """Turn it off when Blender ends the operator: the window closes."""
        end_preview()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Turn it on or off."""
        if current_preview() is not None:
            end_preview()
            return {"FINISHED"}
        try:
            start_preview(active_object(context), context.scene)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class OBJECT_OT_framelet_apply_preview(bpy.types.Operator):
    """Keep what the preview shows, in the place that Output says"""

    bl_idname = "object.framelet_apply_preview"
    bl_label = "Apply"
    bl_options = {"UNDO", "INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Ask for a preview that shows what the settings give."""
        session = current_preview()
        reason = None
        if session is None:
            reason = n_("The live preview is off")
        elif not session.is_current:
            reason = n_("The preview does not show these settings yet")
        return targets.allows(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write it, and report it as a run."""
        from .denoise_report import report_written

        session = current_preview()
        assert session is not None  # see `poll`
        try:
            written = session.apply(settings_of(session.find_object(), context.scene).output)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        report_written(self, context, [written])
        return {"FINISHED"}
