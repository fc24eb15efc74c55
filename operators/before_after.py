# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that shows meshes as before and as after their last run, in turn."""

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from .preview import targets
from .run import run_memory


class OBJECT_OT_framelet_before_after(bpy.types.Operator):
    """Move the vertices of the selected meshes to where they were before the last run, or back"""

    bl_idname = "object.framelet_before_after"
    bl_label = "Before/After"
    bl_options = {"REGISTER", "UNDO"}

    side: bpy.props.EnumProperty(
        name="Show",
        description="Which side of the last run is shown",
        items=[
            ("TOGGLE", "The Other", "The side that is not shown now"),
            ("BEFORE", "Before", "Where the vertices were before the run"),
            ("AFTER", "After", "Where the run moved them"),
        ],
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh that was denoised, in Object Mode or Edit Mode."""
        reason = targets.poll_reason(context)
        if reason is None and not any(map(run_memory.is_remembered, targets.target_objects(context))):
            reason = n_("Denoise a selected mesh first")
        return targets.allows(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Turn every target that was denoised to one side, which the first one gives if none is asked for."""
        wanted: list[bool] = [] if self.side == "TOGGLE" else [self.side == "AFTER"]

        def turn(obj: bpy.types.Object, _progress: targets.Progress) -> bool:
            is_after = run_memory.recall(obj).is_after
            if not wanted:
                wanted.append(not is_after)
            return run_memory.flip(obj) if is_after != wanted[0] else is_after

        done = targets.run_on_targets(self, context, turn)
        if not done:
            return {"CANCELLED"}
        names = targets.names_text(list(done))
        text = (
            rpt_("Showing {names} after denoising") if wanted[0] else rpt_("Showing {names} before denoising")
        )
        self.report({"INFO"}, text.format(names=names))
        return {"FINISHED"}
