# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests in Blender do with objects: make a noisy one, read its positions, select."""

import bpy

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.core import add_noise
from framelet.operators.mesh_io import mesh_bridge


def noisy_monkey(name="Monkey", location=(0, 0, 0)):
    """Return a new object, active and selected alone, with the paper's noise."""
    bpy.ops.mesh.primitive_monkey_add(location=location)
    obj = bpy.context.object
    obj.name = obj.data.name = name
    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, add_noise(surface, 0.2, 1))
    return obj


def read(obj):
    """Return the positions that an operator would read, in both modes."""
    return mesh_bridge.read_surface(obj).vertices


def select_only(*objects):
    """Select these objects and no others; the first becomes active."""
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def edit(obj, *, select=None):
    """Go to Edit Mode with some vertices selected, all by default."""
    bpy.ops.object.mode_set(mode="EDIT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    for vert in edit_mesh.verts:
        vert.select = bool(select is None or select[vert.index])
    bmesh.update_edit_mesh(obj.data)
