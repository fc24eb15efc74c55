# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender properties for the options of a region, generated from the dataclass in `region_options`."""

from dataclasses import Field, fields
from typing import Any

import bpy

from ...core.settings.setting_info import SettingInfo
from .region_options import RegionOptions


def _region_property(item: Field[Any]) -> Any:
    """Return the Blender property of a field."""
    info: SettingInfo = item.metadata["info"]
    common: dict[str, Any] = {
        "name": info.label,
        "description": info.description,
        "default": item.default,
        "options": set(),
    }
    if info.choices:
        return bpy.props.EnumProperty(items=[tuple(choice) for choice in info.choices], **common)
    if item.type == "bool":
        return bpy.props.BoolProperty(**common)
    if item.type == "str":
        return bpy.props.StringProperty(**common)
    common |= {"min": info.minimum, "max": info.maximum}
    if item.type == "int":
        return bpy.props.IntProperty(**common)
    common["soft_max"] = info.soft_maximum
    if info.unit:
        return bpy.props.FloatProperty(unit=info.unit, precision=5, step=1, **common)
    return bpy.props.FloatProperty(precision=3, step=10, **common)


class RegionMixin:
    """A property for each field of `RegionOptions`, for scene settings and operators; not in presets."""

    __annotations__ = {item.name: _region_property(item) for item in fields(RegionOptions)}
