# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that saves the settings of the sidebar as a preset of the user's own, and removes presets.

Blender keeps them as files in the user's folder of presets. The presets that come with Framelet are items of
the setting *Preset* and cannot be removed.
"""

import bpy
from bl_operators.presets import AddPresetBase

from .setting_values import PROPERTY_NAMES

PRESET_FOLDER = "framelet"
"""Below the user's folder `scripts/presets`."""

SAVED_NAMES = tuple(name for name in PROPERTY_NAMES if name != "threads")
"""Without the number of threads, which is the machine's matter. The preset comes first, so that the values
after it have the last word."""


SHOWN = (
    "obj = bpy.context.object",
    "is_own = getattr(getattr(obj, 'framelet', None), 'is_own', False)",
    "settings = (obj if is_own else bpy.context.scene).framelet",
)
"""Lines that find the settings that the sidebar shows; Blender writes them into the files."""


class OBJECT_OT_framelet_preset_add(AddPresetBase, bpy.types.Operator):
    """Save the engine and its settings as a preset of your own, or remove the one that is active"""

    bl_idname = "object.framelet_preset_add"
    bl_label = "Add Framelet Preset"
    preset_menu = "VIEW3D_PT_framelet_presets"
    preset_subdir = PRESET_FOLDER
    preset_defines = SHOWN
    preset_values = tuple(f"settings.{name}" for name in SAVED_NAMES)
