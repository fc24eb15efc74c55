# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file with settings and results of all kinds, and what they say; runs in a Blender of any version.

python stored_work.py make FILE         makes it
python stored_work.py save FILE OTHER   opens it and saves it again
"""

import sys

import bpy
import numpy as np

NOTHING_TO_COMPARE = ("rna_type", "name")


def make():
    """Fill the present file."""
    settings = bpy.context.scene.framelet
    settings.preset, settings.lambda_, settings.frame = "TRI_2", 0.7, "PAIRWISE"
    settings.noise, settings.limit, settings.amount = "WIDE", "EDGES", 0.5
    settings.vertex_group, settings.output = "Group", "SHAPE_KEY"
    bpy.context.scene.framelet_equalizer.gain_2 = 0.4
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_add_noise(seed=1)
    bpy.context.object.vertex_groups.new(name="Group").add(range(250), 1.0, "REPLACE")
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER", amount=0.6)
    bpy.ops.object.framelet_live_equalizer(levels=2, gain_1=0.3, gain_2=1.7, vertex_group="Group")
    bpy.ops.object.framelet_analyze()


def facts():
    """Return what the settings, the modifiers and the shown mesh of the present file say."""
    from framelet.operators.modifier.inputs import input_values

    scene = bpy.context.scene
    found = {}
    for owner in (scene.framelet, scene.framelet_equalizer):
        names = [item.identifier for item in owner.bl_rna.properties]
        found |= {name: getattr(owner, name) for name in names if name not in NOTHING_TO_COMPARE}
    (obj,) = bpy.data.objects
    for modifier in obj.modifiers:
        found[modifier.name] = input_values(modifier)
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    positions = np.empty(3 * len(shown.vertices), np.float32)
    shown.attributes["position"].data.foreach_get("vector", positions)
    return found, positions


def main(action, path, other=""):
    """Do one of the two."""
    from conftest import load_package

    load_package()
    import framelet

    bpy.ops.wm.read_factory_settings(use_empty=True)
    framelet.register()
    try:
        if action == "make":
            make()
        else:
            bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
        bpy.ops.wm.save_as_mainfile(filepath=other or path)
    finally:
        framelet.unregister()


if __name__ == "__main__":
    main(*sys.argv[1:])
