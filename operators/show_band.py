# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that shows a band as colors."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .colors.viewport import show_vertex_colors
from .preview import targets
from .properties.band_settings import ShowMixin, shown_names
from .properties.scene_units import length_text
from .reports.filled_reports import fill_band_range
from .shortage import shortage_told


class OBJECT_OT_framelet_show_band(ShowMixin, bpy.types.Operator):
    """Show a stored band of the selected meshes as vertex colors"""

    bl_idname = "object.framelet_show_band"
    bl_label = "Show Band"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with bands, in Object Mode."""
        return targets.allows(cls, targets.band_poll_reason(context))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, the properties that count."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in shown_names(self):
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Choose the values of all targets, then color them with one range."""
        from .bands.band_values import BandChoice, choose_values
        from .colors.coloring import chosen_limit, color_objects

        choice = BandChoice(self.content, self.level, self.band, self.component)
        done = targets.run_on_targets(self, context, lambda obj, _progress: choose_values(obj, choice))
        if not done:
            return {"CANCELLED"}
        try:
            with shortage_told(", ".join(done)):
                limit = chosen_limit(self, [values for _, values in done.values()])
                found = color_objects(list(done.values()), choice.is_signed, limit)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        show_vertex_colors(context)
        shown = context.window_manager.framelet_band_range
        fill_band_range(shown, list(done), choice.title, found, is_signed=choice.is_signed)
        length = length_text(context.scene, found.limit)
        self.report(
            {"INFO"},
            rpt_(
                "{title} of {names}: colors from {lowest} to {highest}, {share:.1f}% of all are within"
            ).format(
                title=choice.title,
                names=targets.names_text(list(done)),
                lowest=f"−{length}" if choice.is_signed else "0",
                highest=length,
                share=shown.share,
            ),
        )
        return {"FINISHED"}
