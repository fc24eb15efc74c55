# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Register the add-on once, and give every test an empty scene."""

import importlib.util
import os

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
    import framelet

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
    """Start from factory settings and an empty scene."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
