# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator behind the button Denoise, and the one that cancels it."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_n as n_
from bpy.app.translations import pgettext_rpt as rpt_
from bpy.app.translations import pgettext_tip as tip_

from .preview import targets
from .preview.current_preview import end_preview
from .properties.own_settings import remember_settings, shown_settings
from .properties.region_settings import RegionMixin
from .properties.region_values import as_typed, to_region_options
from .properties.setting_values import all_values, fill, to_settings
from .properties.settings import OutputMixin, SettingsMixin
from .run.current_run import IS_RUNNING, current_run, set_current
from .run.run_display import RunDisplay
from .window_events import cancels, is_mesh_being_read

TICK = 0.05
"""Seconds between two looks at a run."""

CANCELED = n_("Canceled; nothing was changed")


class OBJECT_OT_framelet_denoise(SettingsMixin, OutputMixin, RegionMixin, bpy.types.Operator):
    """Remove noise from the selected meshes; in Edit Mode only the selected vertices move"""

    bl_idname = "object.framelet_denoise"
    bl_label = "Denoise"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    from_original: bpy.props.BoolProperty(
        name="From the Original",
        description="Where a mesh still is what the last run made, start from where its vertices were "
        "before; False, if given, starts from the result, also from that in a modifier",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Say what the button does that goes on from a result."""
        if properties.is_property_set("from_original") and not properties.from_original:
            return tip_("Continue from the result: denoise once more what the last run made")
        return ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Ask for a selected mesh, in Object Mode or Edit Mode, and for no run that is going on."""
        return targets.allows(cls, IS_RUNNING if current_run() else targets.poll_reason(context))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show, when adjusting the last operation, what is changed at once: how much is written, and where.

        Blender stands still while it runs an operator again. The settings are in the sidebar, whose button
        runs again from the original and leaves Blender usable.
        """
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "amount")
        layout.prop(self, "output")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Start the run on a thread and stay in charge of it; without a window, run at once."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if not self.properties.is_property_set("from_original"):
            self.from_original = True
        if not self._begin(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(TICK, window=context.window)
        self._display = RunDisplay(context, self._run)
        try:
            self._run.start()
        except Exception:
            self.cancel(context)
            raise
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Look at the run at each tick; Esc and a right click in the view cancel, all else is Blender's."""
        from .run.denoise_run import State

        try:
            if cancels(context, event):
                self._run.cancel()
            # The last tick and the writing after it belong together.
            state = self._run.state if is_mesh_being_read() else self._run.tick()
            if state is State.RUNNING:
                self._display.update(context)
                return {"PASS_THROUGH"}
            self._end(context)
            return self._finish(context)
        except Exception:
            # Blender shows the error; what must not stay is a run that nobody looks at any more.
            self._run.cancel()
            self._end(context)
            raise

    def cancel(self, context: bpy.types.Context) -> None:
        """Give up when Blender ends the operator: the window closes, another file is opened."""
        self._run.cancel()
        self._end(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Denoise every target at once."""
        if not self._begin(context):
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            self._run.run_here(manager.progress_update)
        except BaseException:
            self._run.cancel()  # or it would count as going on for ever
            raise
        finally:
            manager.progress_end()
        return self._finish(context)

    def _begin(self, context: bpy.types.Context) -> bool:
        """Read the targets; report why not if there is nothing to do."""
        from .properties.unused_values import unused_sentences
        from .run.denoise_run import DenoiseRun, begin_run

        try:
            settings = to_settings(self)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return False
        if bpy.app.background or not (self.options.is_invoke or self.options.is_repeat):
            # Only a script names what has no effect; the sidebar does not show it.
            for sentence in unused_sentences(self, settings):
                self.report({"WARNING"}, sentence)
        # The panel for adjusting the last operation shows the values that were used, defaults included.
        fill(self, all_values(self))
        end_preview()
        if self.options.is_repeat:
            settings_shown = shown_settings(context)
            settings_shown.amount, settings_shown.output = self.amount, self.output
        is_given = self.properties.is_property_set("from_original")
        try:
            self._run: DenoiseRun = begin_run(
                targets.target_objects(context),
                settings,
                self.output,
                to_region_options(self),
                amount=as_typed(self.amount),
                from_original=self.from_original if is_given else None,
            )
            set_current(self._run)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def _end(self, context: bpy.types.Context) -> None:
        """Take away what shows the run."""
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        self._display.remove()

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Write what came of the run, and report it."""
        from .denoise_report import report_written
        from .run.denoise_run import State

        run = self._run
        if run.state is State.CANCELED:
            self.report({"INFO"}, rpt_(CANCELED))
            return {"CANCELLED"}
        if run.state is State.FAILED:
            self.report({"ERROR"}, run.reason)
            return {"CANCELLED"}
        written = run.finish()
        if not written:
            self.report({"ERROR"}, run.reason)
            return {"CANCELLED"}
        if self.options.is_invoke:
            # The settings of the active object, which all were denoised with.
            for obj in {each for item in written for each in (item.original, item.obj)}:
                remember_settings(obj, self)
        if run.failures:
            self.report({"WARNING"}, " ".join(run.failures))
        report_written(self, context, written)
        return {"FINISHED"}


class OBJECT_OT_framelet_cancel(bpy.types.Operator):
    """Cancel the run that is going on; everything stays as it was"""

    bl_idname = "object.framelet_cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Ask for a run."""
        return targets.allows(cls, n_("Framelet is not running") if current_run() is None else None)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Cancel; the operator that is in charge of the run ends at its next tick."""
        run = current_run()
        if run is not None:
            run.cancel()
        return {"FINISHED"}
