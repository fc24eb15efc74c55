# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling leave nothing behind, and can be repeated.

`FRAMELET_CYCLES=1000` repeats it as often as it says; `make hunt-blender` does so.
"""

import gc
import os
import subprocess
import sys
from pathlib import Path

import bpy
import framelet
import pytest
from framelet.operators.preview import current_preview
from framelet.ui import menus
from framelet.ui.legend import legend
from process_memory import resident_megabytes

OPERATORS = (
    "framelet_denoise",
    "framelet_estimate_noise",
    "framelet_add_noise",
    "framelet_compare",
    "framelet_analyze",
    "framelet_show_band",
    "framelet_synthesize",
    "framelet_clear",
    "framelet_equalize",
    "framelet_before_after",
    "framelet_heat_map",
    "framelet_hide_colors",
)
ROOT = Path(__file__).resolve().parents[2]
N_CYCLES = int(os.environ.get("FRAMELET_CYCLES", "20"))


def traces():
    """Return everything of Framelet that Blender knows."""
    found = {name for name in dir(bpy.types) if "framelet" in name.lower()}
    for owner in (bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object, bpy.types.Mesh):
        found |= {f"{owner.__name__}.{name}" for name in dir(owner) if "framelet" in name}
    found |= {f"ops.{name}" for name in dir(bpy.ops.object) if "framelet" in name}
    for name, _ in menus.ENTRIES:
        drawers = getattr(bpy.types, name)._dyn_ui_initialize()
        found |= {f"{name}.{drawer.__name__}" for drawer in drawers if "framelet" in drawer.__module__}
    found |= {f"handler {name} {each.__name__}" for name, each in our_handlers()}
    if bpy.app.timers.is_registered(current_preview._on_timer):
        found.add("timer")
    if legend._handle is not None:
        found.add("legend")
    for keymap in bpy.context.window_manager.keyconfigs.addon.keymaps:
        found |= {f"key {item.idname}" for item in keymap.keymap_items if "framelet" in item.idname}
    return found


def our_handlers():
    """Return name and function of each handler of Framelet, as often as it is there."""
    lists = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return [
        (name, each)
        for name, found in lists.items()
        if isinstance(found, list)
        for each in found
        if each.__module__.startswith("framelet.")
    ]


@pytest.fixture
def registered_again():
    """Leave the add-on registered, whatever the test did."""
    yield
    if not hasattr(bpy.types.Scene, "framelet"):
        framelet.register()


def test_register_unregister_register(registered_again):
    before = traces()
    assert {f"ops.{name}" for name in OPERATORS} <= before
    assert "Scene.framelet" in before and "WindowManager.framelet_report" in before
    framelet.unregister()
    assert traces() == set()
    framelet.register()
    assert traces() == before
    bpy.ops.mesh.primitive_monkey_add()
    assert bpy.ops.object.framelet_denoise() == {"FINISHED"}


def test_many_cycles_leak_nothing(registered_again):
    before, n_handlers = traces(), len(our_handlers())
    assert len({name for name, _ in our_handlers()}) == n_handlers > 0
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.framelet_denoise(preset="POSITIONS", output="MODIFIER")
    n_groups = len(bpy.data.node_groups)

    def cycle(number):
        for _ in range(number):
            framelet.unregister()
            framelet.register()
        gc.collect()
        return len(gc.get_objects()), resident_megabytes()

    n_objects, megabytes = cycle(5)
    framelet.unregister()
    assert traces() == set()
    framelet.register()
    n_after, megabytes_after = cycle(N_CYCLES)
    assert traces() == before
    assert len(our_handlers()) == n_handlers and len(bpy.data.node_groups) == n_groups
    assert n_after <= n_objects + 50, "objects of Python are left by each cycle"
    assert megabytes_after <= 1.02 * megabytes


def test_operators_are_undoable_and_explained():
    for name in OPERATORS:
        rna = getattr(bpy.ops.object, name).get_rna_type()
        assert rna.name and len(rna.description) > 20, name
    assert bpy.types.OBJECT_OT_framelet_denoise.bl_options == {"REGISTER", "UNDO", "PRESET"}


def test_a_script_that_leaves_it_registered_ends(tmp_path):
    code = f"""
import importlib.util, sys
root = {str(ROOT)!r}
spec = importlib.util.spec_from_file_location(
    "framelet", root + "/__init__.py", submodule_search_locations=[root]
)
package = importlib.util.module_from_spec(spec)
sys.modules["framelet"] = package
spec.loader.exec_module(package)
import bpy
package.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
print(bpy.ops.object.framelet_denoise(preset="TRI_2"), flush=True)
"""
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, timeout=120, encoding="utf-8", check=False
    )
    assert result.returncode == 0, result.stderr
    assert "{'FINISHED'}" in result.stdout
