# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose settings count: an object remembers its own, and the scene has what the next new object starts from.

An object gets settings of its own once the sidebar shows it, with the first change while it is active, or
with a run. What is changed on an object is what new ones start from, but for its vertex group. Changes that
scripts make to the scene's settings are changes of the active object's.

Nothing here refers to bpy, for the reason given in `setting_values`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..context_objects import active_object
from . import setting_values
from .region_values import REGION_NAMES
from .setting_values import PROPERTY_NAMES, write_quietly

if TYPE_CHECKING:
    from collections.abc import Callable

    import bpy

    Update = Callable[[Any, bpy.types.Context], None]

NAMES = (*PROPERTY_NAMES, "output", "amount", *REGION_NAMES)
"""All that an object remembers."""

OF_ONE_OBJECT = ("vertex_group", "invert_group")
"""Settings that mean nothing on another object."""

# True while one copy of the settings follows another one.
_is_following = False


def settings_of(obj: bpy.types.Object | None, scene: bpy.types.Scene) -> Any:
    """Return the settings of an object: its own, or those of the scene as long as it has none."""
    return obj.framelet if obj is not None and has_own(obj) else scene.framelet


def shown_settings(context: bpy.types.Context) -> Any:
    """Return the settings that the sidebar shows."""
    return settings_of(active_object(context), context.scene)


def has_own(obj: bpy.types.Object) -> bool:
    """Tell whether an object has settings of its own."""
    # Blender makes an empty group where one looks into a pointer that was never set.
    return obj.type == "MESH" and obj.is_property_set("framelet") and obj.framelet.is_own


def remember_settings(obj: bpy.types.Object, source: Any) -> None:
    """Give an object settings of its own; one that cannot be edited keeps those of the scene.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object; changed.
    source : FrameletSettings or operator
        The settings.
    """
    if obj.type == "MESH" and obj.is_editable:
        _copy(source, obj.framelet)
        write_quietly(obj.framelet, "is_own", True)


def _copy(source: Any, target: Any) -> None:
    """Copy what is set; what was never set stays so, and has the value of the preset."""
    rna = getattr(source, "properties", source)
    for name in NAMES:
        if rna.is_property_set(name):
            write_quietly(target, name, getattr(rna, name))
        else:
            target.property_unset(name)


def followed(name: str, before: Update | None) -> Update:
    """Return an update function for a setting of scene and objects, which calls another one first."""

    def update(self: Any, context: bpy.types.Context) -> None:
        if before is not None:
            before(self, context)
        _follow(self, name, context)

    return update


def _follow(settings: Any, name: str, context: bpy.types.Context) -> None:
    """Hand a change on: of an object to the scene, of the scene to the active object."""
    global _is_following
    if _is_following or setting_values.is_filling():
        return
    _is_following = True
    try:
        owner, scene = settings.id_data, context.scene
        if owner == scene:
            obj = context.view_layer.objects.active
            if obj is None or obj.type != "MESH" or not obj.is_editable:
                return
            if has_own(obj):
                setattr(obj.framelet, name, getattr(settings, name))
            else:
                remember_settings(obj, settings)
            settings = obj.framelet
        elif isinstance(owner, type(scene)):
            return  # another scene, which has its own
        write_quietly(settings, "is_own", True)
        _copy(settings, scene.framelet)
        for each in OF_ONE_OBJECT:
            scene.framelet.property_unset(each)
    finally:
        _is_following = False
