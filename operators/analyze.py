# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that store bands as attributes, and remove them."""

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_

from .colors.viewport import hide_unused_colors
from .mesh_io import band_storage
from .modifier import offsets
from .preview import targets
from .properties.band_settings import StoreMixin
from .properties.region_values import as_typed
from .properties.settings import FrameMixin, LevelsMixin


class OBJECT_OT_framelet_analyze(FrameMixin, LevelsMixin, StoreMixin, bpy.types.Operator):
    """Split the selected meshes into bands, and store these as attributes for nodes, scripts and display"""

    bl_idname = "object.framelet_analyze"
    bl_label = "Analyze"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode."""
        return targets.allows(cls, targets.poll_reason(context, in_object_mode=True))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Analyze every target."""
        from .bands.bands import analyze_object, megabytes_text

        done = targets.run_on_targets(
            self,
            context,
            lambda obj, _progress: analyze_object(
                obj, self.frame, self.stencil, self.levels, self.boundary, as_typed(self.max_megabytes)
            ),
        )
        if not done:
            return {"CANCELLED"}
        n_bands = sum(sum(note.n_bands) for note, _ in done.values())
        n_bytes = sum(size for _, size in done.values())
        self.report(
            {"INFO"},
            rpt_("Stored {number} bands of {names}: {size}").format(
                number=n_bands, names=targets.names_text(list(done)), size=megabytes_text(n_bytes)
            ),
        )
        return {"FINISHED"}


class OBJECT_OT_framelet_clear(bpy.types.Operator):
    """Remove all that Framelet stored on the selected meshes: bands, colors, the noise, and modifiers"""

    bl_idname = "object.framelet_clear"
    bl_label = "Clear Bands"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh with something to remove, in Object Mode."""
        reason = targets.poll_reason(context, in_object_mode=True)
        if reason is None and not any(
            band_storage.has_traces(obj.data) or offsets.has_traces(obj.data)
            for obj in targets.target_objects(context)
        ):
            reason = n_("The selected meshes have nothing to remove")
        return targets.allows(cls, reason)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Clear every target."""
        from .bands.bands import clear_object

        done = targets.run_on_targets(self, context, lambda obj, _progress: clear_object(obj))
        if not done:
            return {"CANCELLED"}
        hide_unused_colors(context)
        self.report(
            {"INFO"}, rpt_("Removed the bands of {names}").format(names=targets.names_text(list(done)))
        )
        return {"FINISHED"}
