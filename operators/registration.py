# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the operators, the pointers to their data, and the command line."""

import bpy
from bpy.utils import register_classes_factory

from . import edit_modifier, handlers, outliers
from .add_noise import OBJECT_OT_framelet_add_noise
from .analyze import OBJECT_OT_framelet_analyze, OBJECT_OT_framelet_clear
from .before_after import OBJECT_OT_framelet_before_after
from .colors.heat_settings import FrameletHeatMap
from .command_line import blender_command
from .compare import OBJECT_OT_framelet_compare
from .denoise import OBJECT_OT_framelet_cancel, OBJECT_OT_framelet_denoise
from .equalize import OBJECT_OT_framelet_equalize, OBJECT_OT_framelet_live_equalizer
from .estimate_noise import OBJECT_OT_framelet_estimate_noise
from .heat_map import OBJECT_OT_framelet_heat_map, OBJECT_OT_framelet_hide_colors
from .live_preview import OBJECT_OT_framelet_apply_preview, OBJECT_OT_framelet_preview
from .mesh_io import mesh_facts
from .pick_face_set import OBJECT_OT_framelet_pick_face_set
from .properties.band_settings import FrameletBands, FrameletEqualizer
from .properties.presets import OBJECT_OT_framelet_preset_add
from .properties.settings import FrameletSettings
from .reports.report import (
    FrameletBandRange,
    FrameletComparison,
    FrameletEstimate,
    FrameletName,
    FrameletNoise,
    FrameletReport,
)
from .show_band import OBJECT_OT_framelet_show_band
from .synthesize import OBJECT_OT_framelet_synthesize

classes = (
    FrameletSettings,
    FrameletNoise,
    FrameletEstimate,
    FrameletReport,
    FrameletComparison,
    FrameletName,
    FrameletBandRange,
    FrameletBands,
    FrameletEqualizer,
    FrameletHeatMap,
    OBJECT_OT_framelet_denoise,
    OBJECT_OT_framelet_cancel,
    OBJECT_OT_framelet_preview,
    OBJECT_OT_framelet_apply_preview,
    OBJECT_OT_framelet_estimate_noise,
    OBJECT_OT_framelet_add_noise,
    OBJECT_OT_framelet_compare,
    OBJECT_OT_framelet_analyze,
    OBJECT_OT_framelet_show_band,
    OBJECT_OT_framelet_synthesize,
    OBJECT_OT_framelet_clear,
    OBJECT_OT_framelet_equalize,
    OBJECT_OT_framelet_live_equalizer,
    OBJECT_OT_framelet_before_after,
    OBJECT_OT_framelet_heat_map,
    OBJECT_OT_framelet_hide_colors,
    OBJECT_OT_framelet_preset_add,
    OBJECT_OT_framelet_pick_face_set,
    *edit_modifier.classes,
    *outliers.classes,
)

POINTERS = (
    (bpy.types.Scene, "framelet", FrameletSettings),
    (bpy.types.Object, "framelet", FrameletSettings),
    (bpy.types.Scene, "framelet_bands", FrameletBands),
    (bpy.types.Scene, "framelet_equalizer", FrameletEqualizer),
    (bpy.types.Scene, "framelet_heat_map", FrameletHeatMap),
    (bpy.types.WindowManager, "framelet_report", FrameletReport),
    (bpy.types.WindowManager, "framelet_estimate", FrameletEstimate),
    (bpy.types.WindowManager, "framelet_comparison", FrameletComparison),
    (bpy.types.WindowManager, "framelet_band_range", FrameletBandRange),
)
"""Owner, name and class of what is kept with scenes, objects and windows."""

_register_classes, _unregister_classes = register_classes_factory(classes)


def register() -> None:
    """Register the classes, the pointers to them and the command."""
    _register_classes()
    for owner, name, kind in POINTERS:
        setattr(owner, name, bpy.props.PointerProperty(type=kind))
    handlers.register()
    blender_command.register()


def unregister() -> None:
    """Take everything away in reverse order."""
    blender_command.unregister()
    handlers.unregister()
    for owner, name, _ in reversed(POINTERS):
        delattr(owner, name)
    mesh_facts.forget_facts()
    _unregister_classes()
