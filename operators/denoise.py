# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator behind the button Denoise."""

import bpy

from . import targets
from .denoise_object import denoise_and_measure
from .filled_reports import fill_estimate_of_run, fill_report
from .heat_map import refresh_heat
from .report import FrameletReport
from .scene_units import length_text, noise_text
from .setting_values import PROPERTY_NAMES, fill, has_effect, is_replaced, to_settings
from .settings import SettingsMixin


class OBJECT_OT_framelet_denoise(SettingsMixin, bpy.types.Operator):
    """Remove noise from the selected meshes; in Edit Mode only the selected vertices move"""

    bl_idname = "object.framelet_denoise"
    bl_label = "Denoise"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode."""
        reason = targets.poll_reason(context)
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def draw(self, _context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, the settings that the method uses."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in PROPERTY_NAMES:
            if has_effect(self.method, name):
                row = layout.row()
                row.active = not is_replaced(self.method, self.tuning, name)
                row.prop(self, name)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Denoise every target and fill the report of the last run."""
        settings = to_settings(self)
        # The panel for adjusting the last operation shows the values that were used, defaults included.
        fill(self, settings)
        measured = targets.run_on_targets(
            self, context, lambda obj, progress: denoise_and_measure(obj, settings, progress)
        )
        if not measured:
            return {"CANCELLED"}
        report = context.window_manager.framelet_report
        fill_report(report, measured)
        fill_estimate_of_run(context.window_manager.framelet_estimate, measured)
        refresh_heat(context, [bpy.data.objects[name] for name in measured])
        self.report(
            {"INFO"},
            f"Denoised {targets.names_text(list(measured))}: {report.n_moved:,} of {report.n_vertices:,} "
            f"vertices moved, {length_text(context.scene, report.displacement_rms)} RMS "
            f"({report.displacement_rms_edges:.3f} edge lengths), in {report.seconds:.2f} s"
            f"{_noise_words(context.scene, report)}",
        )
        return {"FINISHED"}


def _noise_words(scene: bpy.types.Scene, report: FrameletReport) -> str:
    """Say which noise was measured and what was made of it; nothing if it was not measured."""
    if not report.has_noise:
        return ""
    noise = noise_text(scene, report.noise_sigma, report.noise_sigma_edges, report.is_impulsive)
    taken = report.recipe or report.parameters
    return f"; noise {noise}" + (f"; used {taken}" if taken else "")
