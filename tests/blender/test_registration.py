# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling leave nothing behind, and can be repeated."""

import subprocess
import sys
from pathlib import Path

import bpy
import framelet
import pytest
from framelet.ui import menus

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


def traces():
    """Return everything of Framelet that Blender knows."""
    found = {name for name in dir(bpy.types) if "framelet" in name.lower()}
    for owner in (bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object, bpy.types.Mesh):
        found |= {f"{owner.__name__}.{name}" for name in dir(owner) if "framelet" in name}
    found |= {f"ops.{name}" for name in dir(bpy.ops.object) if "framelet" in name}
    for name, _ in menus.ENTRIES:
        drawers = getattr(bpy.types, name)._dyn_ui_initialize()
        found |= {f"{name}.{drawer.__name__}" for drawer in drawers if "framelet" in drawer.__module__}
    return found


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
