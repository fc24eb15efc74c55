# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Install, use, disable and enable the extension's zip; write what was seen as JSON.

Run in a process of its own, with the user's folders set to temporary ones, because
an install writes preferences: ``python lifecycle.py framelet.zip``.
"""

import json
import os
import sys
import tempfile

import bpy
import numpy as np

MODULE = "bl_ext.user_default.framelet"
COMMAND = "framelet"


def main(zip_path):
    seen = {}
    bpy.ops.wm.read_factory_settings(use_empty=True)
    seen["before"] = traces()
    installed = bpy.ops.extensions.package_install_files(
        filepath=zip_path, repo="user_default", enable_on_install=True
    )
    try:
        seen["installed"] = sorted(installed)
        seen["enabled"] = is_enabled()
        seen["traces"] = traces()
        seen["first_use"] = use()
        bpy.ops.preferences.addon_disable(module=MODULE)
        seen["enabled_after_disable"] = is_enabled()
        seen["traces_after_disable"] = traces()
        bpy.ops.preferences.addon_enable(module=MODULE)
        seen["enabled_again"] = is_enabled()
        seen["traces_again"] = traces()
        seen["second_use"] = use()
    finally:
        # Classes that are registered when Python exits hang or crash Blender 4.x.
        if is_enabled():
            bpy.ops.preferences.addon_disable(module=MODULE)
    # After a line break, because Blender's own output may end without one.
    sys.stdout.write("\n" + json.dumps(seen) + "\n")


def use():
    """Add noise to a sphere, take it away again, and measure both."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    mesh = bpy.context.object.data
    clean = positions(mesh)
    polls = bool(bpy.ops.object.framelet_denoise.poll())
    added = bpy.ops.object.framelet_add_noise(sigma=0.2, seed=1)
    noisy = positions(mesh)
    denoised = bpy.ops.object.framelet_denoise()
    result = positions(mesh)
    return {
        "polls": polls,
        "finished": [sorted(added), sorted(denoised)],
        "finite": bool(np.isfinite(result).all()),
        "moved_by_noise": float(np.abs(noisy - clean).max()),
        "moved_by_denoise": float(np.abs(result - noisy).max()),
    }


def positions(mesh):
    """Return the vertex positions as a flat array."""
    array = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", array)
    return array


def is_enabled():
    return MODULE in bpy.context.preferences.addons


def traces():
    """Return the names of all that the extension has put into Blender."""
    found = [f"bpy.types.{name}" for name in dir(bpy.types) if "framelet" in name.lower()]
    for base in (bpy.types.PropertyGroup, bpy.types.Operator, bpy.types.Panel, bpy.types.Menu):
        found += [f"class {c.__name__}" for c in base.__subclasses__() if is_ours(c)]
    for owner in (bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object, bpy.types.Mesh):
        properties = [p.identifier for p in owner.bl_rna.properties]
        found += [f"{owner.__name__}.{name}" for name in properties if "framelet" in name]
    for group in ("object", "mesh", "wm", "scene"):
        operators = dir(getattr(bpy.ops, group))
        found += [f"bpy.ops.{group}.{name}" for name in operators if "framelet" in name]
    if is_command_registered():
        found.append(f"command {COMMAND}")
    return sorted(set(found))


def is_ours(cls):
    """Return whether a class is registered and comes from the extension."""
    return cls.__module__.startswith(MODULE) and cls.is_registered


def is_command_registered():
    """Return whether the name of our command is taken.

    Blender does not list its commands, but warns on stderr of a second one of the same name.
    """
    with tempfile.TemporaryFile() as file:
        stderr = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            bpy.utils.unregister_cli_command(bpy.utils.register_cli_command(COMMAND, print))
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)
        file.seek(0)
        return b"duplicate command" in file.read()


if __name__ == "__main__":
    main(sys.argv[1])
