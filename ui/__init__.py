# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What users see: panels, menu entries and the legend."""

from bpy.utils import register_classes_factory

from . import menus, translations
from .legend import legend
from .panels import (
    band_panels,
    outlier_panel,
    output_panel,
    panel,
    preset_panel,
    region_panel,
    report_panels,
    see_panel,
)

# Subpanels are shown in this order.
classes = (
    *preset_panel.classes,
    panel.VIEW3D_PT_framelet,
    *output_panel.classes,
    *region_panel.classes,
    *see_panel.classes,
    *report_panels.classes,
    *band_panels.classes,
    *outlier_panel.classes,
    panel.VIEW3D_PT_framelet_advanced,
    *report_panels.sample_classes,
    *menus.classes,
)

_register_classes, _unregister_classes = register_classes_factory(classes)


def register() -> None:
    """Register the panels, then the menu entries and the legend."""
    _register_classes()
    menus.register()
    legend.register()
    translations.register()


def unregister() -> None:
    """Take everything away in reverse order."""
    translations.unregister()
    legend.unregister()
    menus.unregister()
    _unregister_classes()
