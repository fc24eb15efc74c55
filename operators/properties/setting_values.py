# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender properties to settings and back, and how a preset and the fields keep in step.

Nothing here refers to bpy. Blender 4.2 never frees a PropertyGroup class, so that what its update functions
refer to outlives Python, and the module bpy crashes when it does.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...core.settings import DEFAULT_PRESET, INFOS, PRESETS, DenoiseSettings, used_settings
from .region_values import REGION_NAMES, as_typed

if TYPE_CHECKING:
    import bpy

CUSTOM = "CUSTOM"

DEFINING = ("method", "frame", "stencil", "shrinkage")
"""The settings that make the algorithm; one that is used and differs from the preset's makes it a custom
combination."""

SETTING_NAMES = tuple(INFOS)
PROPERTY_NAMES = ("preset", *SETTING_NAMES)

FRAME_NAMES = ("frame", "stencil", "levels", "boundary")
"""The settings of the frame transform itself."""

# True while a preset fills the fields, so that their own updates do not answer.
_is_filling = False


def has_effect(method: str, name: str) -> bool:
    """Tell whether a setting is used by a method."""
    return name not in INFOS or INFOS[name].has_effect(method)


def is_filling() -> bool:
    """Tell whether a preset is filling the fields."""
    return _is_filling


def fill(properties: Any, settings: DenoiseSettings | Mapping[str, Any], keep: tuple[str, ...] = ()) -> None:
    """Write settings to properties, and leave the preset's name as it is.

    Parameters
    ----------
    properties : SettingsMixin
        Scene settings or an operator; changed.
    settings : DenoiseSettings or mapping
        The values, by name.
    keep : tuple of str
        Names that are not written.
    """
    global _is_filling
    values = vars(settings) if isinstance(settings, DenoiseSettings) else settings
    outer, _is_filling = _is_filling, True
    try:
        for name in SETTING_NAMES:
            if name not in keep:
                setattr(properties, name, values[name])
    finally:
        _is_filling = outer


def all_values(properties: Any) -> dict[str, Any]:
    """Return the values of all settings by name, those that the method does not use included.

    Parameters
    ----------
    properties : SettingsMixin
        Scene settings or an operator. Values that were never set are those of the preset,
        of a custom combination those of the default preset.
    """
    rna = getattr(properties, "properties", properties)
    changes = {name: as_typed(getattr(rna, name)) for name in SETTING_NAMES if rna.is_property_set(name)}
    base = PRESETS.get(rna.preset, PRESETS[DEFAULT_PRESET]).settings
    return vars(base) | changes


def to_settings(properties: Any) -> DenoiseSettings:
    """Return the settings that properties stand for, see `all_values`, as far as their method uses them.

    Raises
    ------
    SettingError
        In one sentence, if a value is not allowed.
    """
    return DenoiseSettings(**used_settings(all_values(properties)))


def replace_lost(properties: Any) -> None:
    """Take the defaults where a file names choices that are gone; for an engine, with the preset's values."""
    lost = [item.identifier for item in properties.bl_rna.properties if item.type == "ENUM"]
    lost = [name for name in lost if not getattr(properties, name)]
    for name in lost:
        properties.property_unset(name)
    if "method" in lost:
        preset = PRESETS.get(properties.preset, PRESETS[DEFAULT_PRESET])
        fill(properties, preset.settings, keep=("threads",))


def copy_settings(source: Any, target: Any) -> None:
    """Copy all properties of scene settings to an operator, so that the operator needs nothing else."""
    copy_values(source, target, ("preset", "output", "amount", *REGION_NAMES))
    for name, value in all_values(source).items():
        write_quietly(target, name, value)


def copy_frame_settings(source: Any, target: Any, names: tuple[str, ...] = FRAME_NAMES) -> None:
    """Copy the settings of the frame transform from scene settings to an operator."""
    values = all_values(source)
    for name in names:
        write_quietly(target, name, values[name])


def copy_values(source: Any, target: Any, names: tuple[str, ...]) -> None:
    """Copy properties by name, from scene properties to an operator."""
    for name in names:
        write_quietly(target, name, getattr(source, name))


def write_quietly(target: Any, name: str, value: Any) -> None:
    """Write a property of an operator from a panel, without calling its update function.

    Blender draws all windows again after an update, so that a panel that causes one is drawn forever.
    """
    if not hasattr(target, "bl_rna"):
        setattr(target, name, value)
        return
    prop = target.bl_rna.properties[name]
    if prop.type == "ENUM":
        value = prop.enum_items[value].value
    # Blender 5 keeps what its own properties hold apart from the custom ones.
    is_apart = hasattr(target, "bl_system_properties_get")
    store = target.bl_system_properties_get(do_create=True) if is_apart else target
    store[name] = value


def follow_preset(self: Any, _context: bpy.types.Context) -> None:
    """Fill the fields from the preset; the number of threads is the machine's matter, not the preset's."""
    if self.preset != CUSTOM and not _is_filling:
        fill(self, PRESETS[self.preset].settings, keep=("threads",))


def leave_preset(self: Any, _context: bpy.types.Context) -> None:
    """Call the combination custom once it is no longer the preset's."""
    if _is_filling or self.preset == CUSTOM:
        return
    settings = PRESETS[self.preset].settings
    names = [name for name in DEFINING if has_effect(settings.method, name)]
    if any(getattr(self, name) != getattr(settings, name) for name in names):
        self.preset = CUSTOM
