# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of the heat map, for its operator and for the sidebar to keep.

The classes have no methods, for the reason given in `setting_values`.
"""

from math import pi, radians
from typing import Any

import bpy
from bpy.props import EnumProperty, FloatProperty

from ..mesh_io.band_storage import NOISE, NOISE_WIDTH
from ..properties.band_settings import RangeMixin
from .heat_values import QUANTITIES

HEAT_NAMES = (
    "range_rule",
    "percentile",
    "limit",
    "limit_angle",
    "limit_edges",
    "tolerance",
    "tolerance_angle",
)
LIMITS = {"LENGTH": "limit", "ANGLE": "limit_angle", "EDGES": "limit_edges"}
"""The properties that hold a limit of one's own, by unit."""

TOLERANCES = {"LENGTH": "tolerance", "ANGLE": "tolerance_angle"}
"""The properties that hold what is small enough, by unit."""

_TOLERANCE_WORDS = "What is at most this far off is green, in {}: larger makes more green; 0 leaves green out"


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
            (
                "NOISE",
                "Noise",
                f"How strong the noise was that went, also as the attribute {NOISE}, for nodes and masks",
            ),
            (
                "WIDTH",
                "Noise Width",
                f"How many edges wide it was, also as the attribute {NOISE_WIDTH}; 0 if each vertex differs",
            ),
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
    limit_edges: FloatProperty(
        name="Limit",
        description="The width that gets the last color, in edge lengths: larger makes all colors paler",
        default=4.0,
        min=0.001,
        soft_max=20.0,
        precision=2,
        options=set(),
    )

    tolerance: FloatProperty(
        name="Tolerance",
        description=_TOLERANCE_WORDS.format("scene units"),
        default=0.0,
        min=0.0,
        soft_max=1.0,
        unit="LENGTH",
        precision=5,
        step=1,
        options=set(),
    )
    tolerance_angle: FloatProperty(
        name="Tolerance",
        description=_TOLERANCE_WORDS.format("degrees"),
        default=0.0,
        min=0.0,
        max=pi,
        subtype="ANGLE",
        options=set(),
    )


def shown_heat_names(properties: Any, quantity: str) -> tuple[str, ...]:
    """Return the names of a `HeatMixin` that count with its present range and a quantity."""
    unit = QUANTITIES[quantity].unit if quantity in QUANTITIES else ""  # an unknown one in a file
    more = {"PERCENTILE": "percentile", "FIXED": LIMITS.get(unit)}
    shown = ("range_rule", more.get(properties.range_rule), TOLERANCES.get(unit))
    return tuple(name for name in HEAT_NAMES if name in shown)


class FrameletHeatMap(HeatMixin, bpy.types.PropertyGroup):
    """The heat map in the sidebar, kept with the scene."""
