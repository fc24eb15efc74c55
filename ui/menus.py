# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus, which use the settings of the scene as the sidebar does."""

from __future__ import annotations

import bpy

from ..operators.denoise import OBJECT_OT_framelet_denoise
from ..operators.setting_values import copy_settings

MENU_NAMES = ("VIEW3D_MT_object", "VIEW3D_MT_edit_mesh_clean")


def _draw_denoise(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw the entry at the end of a menu."""
    self.layout.separator()
    operator = self.layout.operator(OBJECT_OT_framelet_denoise.bl_idname, text="Denoise (Framelet)")
    copy_settings(context.scene.framelet, operator)


def register() -> None:
    """Add the entries."""
    for name in MENU_NAMES:
        getattr(bpy.types, name).append(_draw_denoise)


def unregister() -> None:
    """Take the entries away."""
    for name in reversed(MENU_NAMES):
        getattr(bpy.types, name).remove(_draw_denoise)
