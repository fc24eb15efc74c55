# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that picks the face set to denoise, by a click in the view."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_
from bpy_extras import view3d_utils

from .preview import targets
from .window_events import view_under_mouse

ASK = n_("Click a face of the set to denoise; Esc or Right Click: Cancel")


class OBJECT_OT_framelet_pick_face_set(bpy.types.Operator):
    """Click a face of the active mesh: only its face set is denoised"""

    bl_idname = "object.framelet_pick_face_set"
    bl_label = "Pick Face Set"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for an active mesh."""
        active = context.active_object
        reason = None if active is not None and active.type == "MESH" else n_("Make a mesh object active")
        return targets.allows(cls, reason)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Wait for a click."""
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set(rpt_(ASK))
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Take the set under the mouse at a click, and leave moving the view to Blender."""
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}
        self.cancel(context)
        number = _number_under_mouse(context, event)
        if number is None:
            self.report({"WARNING"}, rpt_("No face of the active mesh is there"))
            return {"CANCELLED"}
        context.scene.framelet.face_set = number
        self.report({"INFO"}, rpt_("Face set {number}").format(number=number))
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give back the mouse and the status bar."""
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


NAVIGATION = frozenset({"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "MOUSEMOVE", "INBETWEEN_MOUSEMOVE"})


def _number_under_mouse(context: bpy.types.Context, event: bpy.types.Event) -> int | None:
    """Return the number of the face set of the active mesh under the mouse, if there is one."""
    from .mesh_io.face_sets import face_set_under

    found = view_under_mouse(context, event)
    if found is None:
        return None
    area, region = found
    space = area.spaces.active.region_3d
    place = (event.mouse_x - region.x, event.mouse_y - region.y)
    origin = view3d_utils.region_2d_to_origin_3d(region, space, place)
    direction = view3d_utils.region_2d_to_vector_3d(region, space, place)
    return face_set_under(context.active_object, context.evaluated_depsgraph_get(), origin, direction)
