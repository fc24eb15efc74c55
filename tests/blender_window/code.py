# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Code that tests run in Blender: meshes, their positions, and a fresh start."""

RESET = """
import sys
interface = next(module for name, module in sys.modules.items() if name.endswith(".framelet.ui"))
interface.unregister()
for panel in bpy.types.Panel.__subclasses__():
    if panel.__name__.startswith("VIEW3D_PT_framelet_"):
        options = vars(panel).get("options_at_first", set(getattr(panel, "bl_options", ())))
        panel.options_at_first = options
        panel.bl_options = options - {"DEFAULT_CLOSED"} if panel.__name__ in unfolded else options
interface.register()
with bpy.context.temp_override(window=window()):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
"""
"""Which subpanels are open is a matter of their options, until Blender has drawn them for the first time."""

EMPTY = """
import hashlib
import numpy as np

for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)

def positions(name):
    # As it is shown: modifiers count.
    mesh = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get()).data
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

def report():
    found = bpy.context.window_manager.framelet_report
    return [found.n_objects, found.n_moved]
"""

BALL = """
add_ball("Ball", subdivisions)
with override():
    bpy.ops.view3d.view_selected()
remember("Made")
"""

MONKEY = """
with override():
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    obj.name = "Monkey"
    obj.modifiers.new("Subdivision", "SUBSURF").levels = subdivisions
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    obj.modifiers.new("Triangulate", "TRIANGULATE").quad_method = "BEAUTY"
    bpy.ops.object.modifier_apply(modifier="Triangulate")
    bpy.ops.object.framelet_add_noise(sigma=0.2, seed=0)
    bpy.ops.view3d.view_axis(type="FRONT")
    space = view3d().spaces.active
    space.region_3d.view_perspective = "PERSP"
    bpy.ops.view3d.view_orbit(angle=0.3, type="ORBITRIGHT")
    bpy.ops.view3d.view_selected()
    space.region_3d.view_distance *= 1.12
    space.region_3d.view_location.x += 0.3
remember("Made")
"""
"""Blender's monkey with noise, seen from the front, left of the sidebar."""
