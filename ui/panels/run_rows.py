# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The row below the button Denoise: how far a run is, or else the live preview."""

from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface as iface_

from ...operators.denoise import OBJECT_OT_framelet_cancel
from ...operators.live_preview import OBJECT_OT_framelet_apply_preview, OBJECT_OT_framelet_preview
from ...operators.preview.current_preview import current_preview, preview_message
from ...operators.run.current_run import current_run
from ...operators.run.run_display import progress_text
from .layouts import draw_text

LONG_NAME = 10
"""Letters of a name that has room beside other words, in a sidebar as wide as Blender makes it."""


def draw_run(layout: bpy.types.UILayout) -> None:
    """Draw one row: a bar and a button that cancels while a run is going on, else that of the preview.

    It is always there, so that no slider moves under the mouse; during a run there is no preview.
    """
    row, run = layout.row(align=True), current_run()
    if run is None:
        draw_preview(row)
        return
    row.progress(factor=run.fraction, text=progress_text(run))
    row.operator(OBJECT_OT_framelet_cancel.bl_idname, text="", icon="X")


def draw_preview(row: bpy.types.UILayout) -> None:
    """Draw the toggle of the preview and, while it is on, the button that keeps it."""
    session = current_preview()
    if session is None:
        row.operator(OBJECT_OT_framelet_preview.bl_idname, icon="HIDE_OFF")
    else:
        # The name says whose preview it is, as another object may be active: it gets most of the row.
        row = row.split(factor=0.68, align=True)
        is_busy = not session.is_current and not session.message
        row.operator(
            OBJECT_OT_framelet_preview.bl_idname,
            text=preview_text(session.name),
            translate=False,
            icon="SORTTIME" if is_busy else "HIDE_OFF",
            depress=True,
        )
        # The bar takes the place of the button, so that no slider moves under the mouse.
        if is_busy:
            row.progress(factor=session.fraction, text=f"{session.fraction:.0%}")
        else:
            row.operator(OBJECT_OT_framelet_apply_preview.bl_idname, icon="CHECKMARK")


def preview_text(name: str) -> str:
    """Return the words on the button of a preview that is on; a long name is all that there is room for."""
    quoted = f"‘{name}’"
    return quoted if len(name) > LONG_NAME else iface_("Preview of {name}").format(name=quoted)


def draw_message(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw what the preview has to say, for below the settings."""
    if preview_message():
        draw_text(layout.column(align=True), context, preview_message())
