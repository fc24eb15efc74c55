# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the operators, the pointers to their data, and the command line."""

import bpy
from bpy.utils import register_classes_factory

from .add_noise import OBJECT_OT_framelet_add_noise
from .command_line import blender_command
from .compare import OBJECT_OT_framelet_compare
from .denoise import OBJECT_OT_framelet_denoise
from .report import FrameletComparison, FrameletReport
from .settings import FrameletSettings

classes = (
    FrameletSettings,
    FrameletReport,
    FrameletComparison,
    OBJECT_OT_framelet_denoise,
    OBJECT_OT_framelet_add_noise,
    OBJECT_OT_framelet_compare,
)

_register_classes, _unregister_classes = register_classes_factory(classes)


def register() -> None:
    """Register the classes, the pointers to them and the command."""
    _register_classes()
    bpy.types.Scene.framelet = bpy.props.PointerProperty(type=FrameletSettings)
    bpy.types.WindowManager.framelet_report = bpy.props.PointerProperty(type=FrameletReport)
    bpy.types.WindowManager.framelet_comparison = bpy.props.PointerProperty(type=FrameletComparison)
    blender_command.register()


def unregister() -> None:
    """Take everything away in reverse order."""
    blender_command.unregister()
    del bpy.types.WindowManager.framelet_comparison
    del bpy.types.WindowManager.framelet_report
    del bpy.types.Scene.framelet
    _unregister_classes()
