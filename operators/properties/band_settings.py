# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of the operators on bands and of the equalizer, and the same for the sidebar to keep.

The classes have no methods, for the reason given in `setting_values`.
"""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .settings import FIELDS, setting_property

MOST_LEVELS = FIELDS["levels"].metadata["info"].maximum
GAIN_NAMES = tuple(f"gain_{level}" for level in range(1, MOST_LEVELS + 1))
EQUALIZER_NAMES = ("levels", *GAIN_NAMES, "vertex_group", "invert")
SHOW_NAMES = ("content", "level", "band", "component", "range_rule", "percentile", "limit")


class StoreMixin:
    """How much may be stored."""

    max_megabytes: FloatProperty(
        name="Allowed",
        description="Megabytes that the bands of a mesh may take, or nothing is stored: larger allows more",
        default=500.0,
        min=0.0,
        soft_max=4000.0,
        precision=0,
        step=1000,
        options=set(),
    )


class RangeMixin:
    """Which values the colors cover."""

    range_rule: EnumProperty(
        name="Range",
        description="Which values get the last colors of the map; values beyond look the same as those",
        items=[
            ("PERCENTILE", "Percentile", "All but the largest few, so that single spikes do not count"),
            ("MAXIMUM", "Maximum", "The largest value"),
            ("FIXED", "Fixed", "A length of your own, to compare several meshes or bands"),
        ],
        options=set(),
    )
    percentile: FloatProperty(
        name="Percentile",
        description="Share of the values within the range: larger makes it wider, and all colors paler",
        default=98.0,
        min=1.0,
        max=100.0,
        precision=1,
        subtype="PERCENTAGE",
        options=set(),
    )
    limit: FloatProperty(
        name="Limit",
        description="The value that gets the last color, in scene units: larger makes all colors paler",
        default=0.01,
        min=1e-9,
        soft_max=1.0,
        unit="LENGTH",
        precision=4,
        options=set(),
    )


class ShowMixin(RangeMixin):
    """Which band is shown, and which values the colors cover."""

    content: EnumProperty(
        name="Show",
        description="What the colors are made from",
        items=[
            ("BAND", "Band", "One band of a level"),
            ("LEVEL", "Level", "All bands of a level together: the norm over its bands"),
            ("LOW", "Low-Pass", "How far the low-pass, which is left after all levels, is from the surface"),
        ],
        options=set(),
    )
    level: IntProperty(
        name="Level",
        description="Which scale: larger is coarser; 1 is the finest, each further one is twice as coarse",
        default=1,
        min=1,
        max=MOST_LEVELS,
        options=set(),
    )
    band: IntProperty(
        name="Band",
        description="Which band of the level: larger is a later row of the mask-matrix",
        default=1,
        min=1,
        options=set(),
    )
    component: EnumProperty(
        name="Value",
        description="Which number is taken from the vectors of a band",
        items=[
            ("NORMAL", "Along Normal", "Component along the vertex normal: positive points outwards"),
            ("LENGTH", "Length", "Length of the vector, whatever its direction"),
        ],
        options=set(),
    )


def _gain_property(level: int) -> Any:
    """Return the property of one gain."""
    which = "the finest details" if level == 1 else f"details {2 ** (level - 1)} edges wide"
    return FloatProperty(
        name=f"Level {level}",
        description=f"Factor for {which}: larger makes them stronger; 0 removes them, 1 keeps them",
        default=1.0,
        min=0.0,
        max=100.0,
        soft_max=3.0,
        step=5,
        precision=2,
        options=set(),
    )


class EqualizerMixin:
    """One gain for each level, and where it acts."""

    __annotations__ = {
        "levels": setting_property(
            FIELDS["levels"],
            default=3,
            description="Number of scales that have a gain: larger reaches coarser details",
        ),
        **{name: _gain_property(level) for level, name in enumerate(GAIN_NAMES, 1)},
        "vertex_group": StringProperty(
            name="Vertex Group",
            description="Weights of this group scale the change of each vertex; empty changes all alike",
            options=set(),
        ),
        "invert": BoolProperty(
            name="Invert", description="Change the vertices outside of the group instead", options=set()
        ),
    }


def shown_names(properties: Any) -> tuple[str, ...]:
    """Return the names of a `ShowMixin` that count with its present values."""
    hidden = {
        "level": properties.content == "LOW",
        "band": properties.content != "BAND",
        "component": properties.content == "LEVEL",
        "percentile": properties.range_rule != "PERCENTILE",
        "limit": properties.range_rule != "FIXED",
    }
    return tuple(name for name in SHOW_NAMES if not hidden.get(name))


class FrameletBands(StoreMixin, ShowMixin, bpy.types.PropertyGroup):
    """What the sidebar stores and shows, kept with the scene."""


class FrameletEqualizer(EqualizerMixin, bpy.types.PropertyGroup):
    """The equalizer in the sidebar, kept with the scene."""
