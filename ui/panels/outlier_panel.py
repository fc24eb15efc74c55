# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The subpanel Spikes and Islands. It draws and never computes."""

from __future__ import annotations

import bpy

from ...operators.outliers import classes as operators
from .layouts import FrameletPanel


class VIEW3D_PT_framelet_outliers(FrameletPanel, bpy.types.Panel):
    """Select or flatten what is no surface."""

    bl_label = "Spikes and Islands"
    bl_parent_id = "VIEW3D_PT_framelet"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw the buttons."""
        column = self.layout.column(align=True)
        for each in operators:
            column.operator(each.bl_idname)


classes = (VIEW3D_PT_framelet_outliers,)
