# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Code that tests run in Blender: meshes, their positions, and a fresh start."""

RESET = """
with bpy.context.temp_override(window=window()):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
"""

EMPTY = """
import hashlib
import numpy as np

for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)

def positions(name):
    mesh = bpy.data.objects[name].data
    array = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", array)
    return array

def digest(name):
    return hashlib.sha256(positions(name).tobytes()).hexdigest()

def add_ball(name, subdivisions, place=(0.0, 0.0, 0.0), sigma=0.25):
    with override():
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, location=place)
        obj = bpy.context.object
        obj.name = name
        if sigma:
            bpy.ops.object.framelet_add_noise(sigma=sigma, seed=1)
    return obj

def remember(message):
    # Operators that run from Python leave no undo step.
    with override():
        bpy.ops.ed.undo_push(message=message)
"""

BALL = """
add_ball("Ball", subdivisions)
with override():
    bpy.ops.view3d.view_selected()
remember("Made")
"""
