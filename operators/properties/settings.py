# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender properties for the settings of a run, generated from the dataclass in `core.settings`."""

from collections.abc import Iterable
from dataclasses import Field, fields
from typing import Any

import bpy
from bpy.app.translations import pgettext_n as n_

from ...core.settings import DEFAULT_PRESET, PRESETS, DenoiseSettings, SettingInfo
from .output_choices import IN_PLACE, MODIFIER, NEW_OBJECT, OUTPUTS, SHAPE_KEY
from .own_settings import followed
from .region_settings import RegionMixin
from .setting_values import CUSTOM, DEFINING, FRAME_NAMES, follow_preset, leave_preset

FIELDS = {item.name: item for item in fields(DenoiseSettings)}
"""The settings by name."""

CONTEXT = "Framelet"
"""The context of words that mean something else in Blender."""

OWN_WORDS = ("boundary", "frame")
"""Settings whose names Blender's dictionaries take for a sound's end and a picture of a film."""

_DEFAULTS = PRESETS[DEFAULT_PRESET].settings

FIRST_OF_RESEARCH = "POSITIONS"
"""The presets before it are by what the mesh is."""

_NUMBERED = {
    "preset": (
        "AUTO",
        "TRI_1",
        "TRI_2",
        "QUAD_1",
        "QUAD_2",
        "FREE_FORM",
        "PRISMATIC",
        "BILATERAL",
        CUSTOM,
        "POSITIONS",
        "MARCHING_CUBES",
        "SCULPT",
    ),
    "method": ("POSITIONS", "NORMALS", "BILATERAL", "AUTO"),
    "output": (IN_PLACE, SHAPE_KEY, NEW_OBJECT, MODIFIER),
}
"""Lists whose items are shown in another order than they came in. Files hold the numbers of items, so that
new ones go to the end here, and those that are gone keep their place."""


def _items(name: str, choices: Iterable[tuple[str, str, str]]) -> list[tuple[str, str, str, int]]:
    """Return the items of a list with their numbers."""
    items = list(choices)
    order = _NUMBERED.get(name) or [item[0] for item in items]
    return [(*item, order.index(item[0])) for item in items]


def _preset_property() -> Any:
    """Return the property that names a preset."""
    items = [(identifier, preset.label, preset.description) for identifier, preset in PRESETS.items()]
    items.append((CUSTOM, "Custom", "Your own combination"))
    numbered: list[tuple[Any, ...]] = list(_items("preset", items))
    research = next(place for place, item in enumerate(numbered) if item[0] == FIRST_OF_RESEARCH)
    numbered.insert(research, ("", n_("Research"), "", -1))  # a heading
    return bpy.props.EnumProperty(
        name="Preset",
        description="What the mesh is or which algorithm to use; choosing one sets all values below",
        items=numbered,
        default=DEFAULT_PRESET,
        options=set(),
        update=follow_preset,
    )


def setting_property(item: Field[Any], **options: Any) -> Any:
    """Return the Blender property of a dataclass field; `options` add to those that the field gives."""
    info: SettingInfo = item.metadata["info"]
    common: dict[str, Any] = {
        "name": f"{info.label} {info.symbol}".strip(),
        "description": info.description,
        "default": getattr(_DEFAULTS, item.name),
        "options": set(),
    } | options
    if item.name in OWN_WORDS:
        common["translation_context"] = CONTEXT
    if info.choices:
        return bpy.props.EnumProperty(items=_items(item.name, info.choices), **common)
    common |= {"min": info.minimum, "max": info.maximum}
    if info.soft_maximum is not None:
        common["soft_max"] = info.soft_maximum
    if item.type == "int":
        return bpy.props.IntProperty(**common)
    end = info.maximum if info.soft_maximum is None else info.soft_maximum
    assert end is not None  # every number has a range
    return bpy.props.FloatProperty(precision=4 if end <= 0.1 else 3, step=1 if end <= 1.0 else 10, **common)


class SettingsMixin:
    """The preset and a property for each field of `DenoiseSettings`; for scene settings and operators."""

    __annotations__ = {"preset": _preset_property()} | {
        name: setting_property(item, **({"update": leave_preset} if name in DEFINING else {}))
        for name, item in FIELDS.items()
    }


class FrameMixin:
    """The frame without its levels and without a preset; for operators."""

    __annotations__ = {name: setting_property(FIELDS[name]) for name in FRAME_NAMES if name != "levels"}


class LevelsMixin:
    """The number of levels; for operators."""

    __annotations__ = {"levels": setting_property(FIELDS["levels"])}


def _output_property(default: str) -> Any:
    """Return the property that says where the result goes."""
    return bpy.props.EnumProperty(
        name="Output",
        description="Where the denoised surface goes",
        items=_items("output", OUTPUTS),
        default=default,
        options=set(),
    )


class OutputMixin:
    """Where the result goes, and how much of it; for scene settings and operators. Not a part of presets."""

    amount: bpy.props.FloatProperty(
        name="Amount",
        description="Factor for what denoising moves: larger moves farther, 0 leaves the mesh as it is, 1 is "
        "the result. Changing it is instant; Strength says what is taken for noise",
        default=1.0,
        min=0.0,
        max=2.0,
        precision=3,
        subtype="FACTOR",
        options=set(),
    )

    output: _output_property(IN_PLACE)


def _followed_properties(*mixins: type) -> dict[str, Any]:
    """Return the properties of mixins, with scene and object following each other."""
    found = {name: prop for mixin in mixins for name, prop in mixin.__annotations__.items()}
    # In the sidebar the result is a modifier unless something else is chosen; scripts change the mesh itself.
    found["output"] = _output_property(MODIFIER)
    return {
        name: prop.function(**prop.keywords | {"update": followed(name, prop.keywords.get("update"))})
        for name, prop in found.items()
    }


class FrameletSettings(bpy.types.PropertyGroup):
    """The settings that the sidebar shows, stored with each object and, for new objects, with the scene."""

    __annotations__ = _followed_properties(SettingsMixin, OutputMixin, RegionMixin) | {
        "is_own": bpy.props.BoolProperty(
            name="Own Settings", description="The object has settings of its own", options=set()
        )
    }
