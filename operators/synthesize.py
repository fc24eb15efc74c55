# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that rebuilds meshes from their stored bands."""

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .preview import targets
from .properties.scene_units import displacement_in_scene, length_text
from .reports.filled_reports import forget_estimate


class OBJECT_OT_framelet_synthesize(bpy.types.Operator):
    """Rebuild the selected meshes from their stored bands, edited or not"""

    bl_idname = "object.framelet_synthesize"
    bl_label = "Rebuild"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with bands, in Object Mode."""
        return targets.allows(cls, targets.band_poll_reason(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Rebuild every target."""
        from .bands.bands import synthesize_object

        done = targets.run_on_targets(
            self, context, lambda obj, _progress: displacement_in_scene(obj, *synthesize_object(obj))
        )
        if not done:
            return {"CANCELLED"}
        forget_estimate(context.window_manager.framelet_estimate, done)
        largest = max(maximum for _, maximum in done.values())
        self.report(
            {"INFO"},
            rpt_("Rebuilt {names}: vertices moved by up to {length}").format(
                names=targets.names_text(list(done)), length=length_text(context.scene, largest)
            ),
        )
        return {"FINISHED"}
