# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows below the button Denoise: how far a run is."""

from __future__ import annotations

import bpy

from ..operators.current_run import current_run
from ..operators.denoise import OBJECT_OT_framelet_cancel
from ..operators.run_display import progress_text


def draw_progress(layout: bpy.types.UILayout) -> None:
    """Draw a bar and a button that cancels, as long as a run is going on."""
    run = current_run()
    if run is None:
        return
    row = layout.row(align=True)
    row.progress(factor=run.fraction, text=progress_text(run))
    row.operator(OBJECT_OT_framelet_cancel.bl_idname, text="", icon="X")
