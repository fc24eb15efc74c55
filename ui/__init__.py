# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What users see: panels and menu entries."""

from bpy.utils import register_classes_factory

from . import band_panels, menus, panel, report_panels

# Subpanels are shown in this order.
classes = (
    panel.VIEW3D_PT_framelet,
    *band_panels.classes,
    panel.VIEW3D_PT_framelet_advanced,
    *report_panels.classes,
)

_register_classes, _unregister_classes = register_classes_factory(classes)


def register() -> None:
    """Register the panels, then the menu entries."""
    _register_classes()
    menus.register()


def unregister() -> None:
    """Take everything away in reverse order."""
    menus.unregister()
    _unregister_classes()
