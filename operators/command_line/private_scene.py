# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene for imported objects only, after which the session is as it was."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

_NAMED_IN_FILES = ("scenes", "objects", "meshes", "materials", "images")


@contextmanager
def private_scene() -> Iterator[bpy.types.Scene]:
    """Give an empty scene, and remove it and all data made meanwhile on leaving.

    Imported objects, meshes and materials keep the names in their file, since all data of the session are
    renamed for that time: a file with an object Cube would otherwise come out with a Cube.001.
    """
    before = set(bpy.data.user_map())
    renamed = _put_names_aside()
    scene = bpy.data.scenes.new("Scene")
    try:
        yield scene
    finally:
        bpy.data.batch_remove([data for data in bpy.data.user_map() if data not in before])
        for data, name in renamed:
            data.name = name


@contextmanager
def scene_showing(objects: list[bpy.types.Object]) -> Iterator[bpy.types.Scene]:
    """Give a scene that holds these objects and shows them all, since hidden objects are not exported."""
    scene = bpy.data.scenes.new("Framelet")
    hidden = [(obj, obj.hide_viewport, obj.hide_render) for obj in objects]
    try:
        for obj in objects:
            obj.hide_viewport = obj.hide_render = False
            scene.collection.objects.link(obj)
        scene.view_layers[0].update()
        yield scene
    finally:
        for obj, in_viewport, in_render in hidden:
            obj.hide_viewport, obj.hide_render = in_viewport, in_render
        bpy.data.scenes.remove(scene)


def _put_names_aside() -> list[tuple[bpy.types.ID, str]]:
    """Rename all data whose names could clash with those in a file; return them with their names."""
    renamed = []
    for kind in _NAMED_IN_FILES:
        for data in getattr(bpy.data, kind)[:]:
            if data.library is None:
                renamed.append((data, data.name))
                data.name = f".framelet {len(renamed)}"
    return renamed
