# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Register the add-on once, and give every test an empty scene."""

import importlib.util
import os
import threading

import pytest

HAS_BLENDER = importlib.util.find_spec("bpy") is not None

if not HAS_BLENDER and os.environ.get("FRAMELET_REQUIRE_BLENDER") == "1":
    raise pytest.UsageError("FRAMELET_REQUIRE_BLENDER is set, but this Python has no module bpy")


class WithoutBlender(pytest.Module):
    """A test module that is not imported, because its imports would fail."""

    def collect(self):
        pytest.skip("needs the module bpy", allow_module_level=True)


def pytest_pycollect_makemodule(module_path, parent):
    """Skip whole modules where there is no Blender."""
    return None if HAS_BLENDER else WithoutBlender.from_parent(parent, path=module_path)


def pytest_itemcollected(item):
    """Mark every test below this folder."""
    item.add_marker("blender")


@pytest.fixture(scope="session", autouse=True)
def registered():
    """Register the add-on for the session.

    It must be unregistered before Python exits: an operator class that is still
    registered then hangs Blender 4.5 and crashes 4.2.
    """
    import bpy
    import framelet

    bpy.ops.wm.read_factory_settings(use_empty=True)
    framelet.register()
    yield
    framelet.unregister()


@pytest.fixture
def make_object(empty_scene):
    """Give a function that makes an object of a `SurfaceMesh`, and selects it alone."""
    import bpy
    from meshes import faces_of, loose_edges_of

    def make(surface, name="Mesh"):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(surface.vertices.tolist(), loose_edges_of(surface).tolist(), faces_of(surface))
        obj = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(obj)
        bpy.ops.object.select_all(action="DESELECT")
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
        return obj

    return make


@pytest.fixture(autouse=True)
def empty_scene(registered):
    """Start from an empty scene, with all settings of scene and window at their defaults.

    The preferences stay: no test may leave them changed. To load them too, with all of
    Blender's own add-ons, would take six times as long, for each of two thousand tests.
    """
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    manager = bpy.context.window_manager  # which stays when a file is read
    for name in dir(manager):
        if name.startswith("framelet_"):
            manager.property_unset(name)


@pytest.fixture
def settings(empty_scene):
    """Give the settings of the scene, with a quick preset and results in the mesh itself."""
    import bpy

    found = bpy.context.scene.framelet
    found.preset, found.output = "POSITIONS", "IN_PLACE"
    return found


@pytest.fixture
def no_thread_stays(empty_scene):
    """Stop the run and the preview at the end, and fail if one of their threads goes on."""
    from framelet.operators.preview import current_preview
    from framelet.operators.run import current_run
    from run_steps import framelet_threads

    yield
    current_preview.stop_preview()
    current_run.stop_current()
    assert framelet_threads() == []


@pytest.fixture
def gate(monkeypatch):
    """Let the thread of a run wait before the solver until it is opened, or the run is stopped."""
    from framelet.operators.run import denoise_run

    opened, original = threading.Event(), denoise_run.compute

    def compute(job, callback=None, should_stop=None):
        while not opened.wait(0.01):
            if should_stop():
                break
        return original(job, callback, should_stop)

    monkeypatch.setattr(denoise_run, "compute", compute)
    return opened
