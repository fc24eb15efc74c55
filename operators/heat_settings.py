# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of the heat map, for its operator and for the sidebar to keep.

The classes have no methods, for the reason given in `setting_values`.
"""

from math import pi, radians
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty

from .band_settings import RangeMixin

HEAT_NAMES = ("range_rule", "percentile", "limit", "limit_angle")


class HeatMixin(RangeMixin):
    """What a heat map shows, and which values its colors cover."""

    quantity: EnumProperty(
        name="Show",
        description="What the colors are made from",
        items=[
            (
                "NORMAL",
                "Displacement along Normals",
                "How far each vertex moved along the normal of the result: red outwards, blue inwards",
            ),
            ("LENGTH", "Displacement", "How far each vertex moved, whatever the direction"),
            ("ANGLE", "Angle Change", "By how many degrees each face turned"),
        ],
        options=set(),
    )
    limit_angle: FloatProperty(
        name="Limit",
        description="The angle that gets the last color: larger makes all colors paler",
        default=radians(20.0),
        min=radians(0.001),
        max=pi,
        subtype="ANGLE",
        options=set(),
    )


def shown_heat_names(properties: Any, quantity: str) -> tuple[str, ...]:
    """Return the names of a `HeatMixin` that count with its present range and a quantity."""
    is_fixed, is_angle = properties.range_rule == "FIXED", quantity == "ANGLE"
    counts = {
        "percentile": properties.range_rule == "PERCENTILE",
        "limit": is_fixed and not is_angle,
        "limit_angle": is_fixed and is_angle,
    }
    return tuple(name for name in HEAT_NAMES if counts.get(name, True))


class FrameletHeatMap(HeatMixin, bpy.types.PropertyGroup):
    """The heat map in the sidebar, kept with the scene."""
