# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs remember: the second run is the first one's, and any edit of the mesh is seen."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from framelet.core import add_noise, denoise, preparation_cache
from framelet.core.settings import PRESETS
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.run import preparations
from framelet.operators.run.denoise_object import denoise_object

TRI_2 = PRESETS["TRI_2"].settings


@pytest.fixture(autouse=True)
def counted(monkeypatch):
    """Start without memory, and count what is prepared anew."""
    made = []
    original = preparation_cache.prepare_again

    def prepare_again(surface, settings, previous, **more):
        result = original(surface, settings, previous, **more)
        if result is not previous:
            made.append(result)
        return result

    preparations.forget_preparations()
    monkeypatch.setattr(preparation_cache, "prepare_again", prepare_again)
    yield made
    preparations.forget_preparations()


@pytest.fixture
def monkey(empty_scene):
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    surface = mesh_bridge.read_surface(obj)
    mesh_bridge.write_vertices(obj, surface, add_noise(surface, 0.2, 1))
    return obj


def positions(obj):
    return mesh_bridge.read_surface(obj).vertices


def restore(obj, vertices):
    mesh_bridge.write_vertices(obj, mesh_bridge.read_surface(obj), vertices)


def test_a_value_changed_after_a_run_prepares_nothing(monkey, counted):
    noisy = positions(monkey)
    for lambda_ in (0.1, 0.3, 0.5, 0.1):
        restore(monkey, noisy)
        surface = mesh_bridge.read_surface(monkey)
        settings = TRI_2.with_changes(lambda_=lambda_, mu=1.0 + lambda_)
        denoise_object(monkey, settings)
        assert positions(monkey).tobytes() == denoise(surface, settings).vertices.tobytes()
    assert len(counted) == 1


def test_the_operator_after_undo_prepares_nothing(monkey, counted):
    noisy = positions(monkey)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    first = positions(monkey)
    restore(monkey, noisy)
    bpy.ops.object.framelet_denoise(preset="TRI_2", lambda_=0.6)
    second = positions(monkey)
    restore(monkey, noisy)
    bpy.ops.object.framelet_denoise(preset="TRI_2")
    assert positions(monkey).tobytes() == first.tobytes() != second.tobytes()
    assert len(counted) == 1


@pytest.mark.parametrize("edit", ["position", "flip", "subdivide", "delete", "shape key", "stencil"])
def test_any_change_is_seen(monkey, edit, counted):
    settings = TRI_2
    noisy = positions(monkey)
    denoise_object(monkey, settings)
    restore(monkey, noisy)
    if edit == "position":
        monkey.data.vertices[7].co.x += 0.01
    elif edit == "shape key":
        monkey.shape_key_add(name="Basis")
        monkey.shape_key_add(name="Other").data[3].co.z += 0.1
        monkey.active_shape_key_index = 1
    elif edit == "stencil":
        settings = settings.with_changes(stencil="MEAN")
    else:
        edited = bmesh.new()
        edited.from_mesh(monkey.data)
        if edit == "flip":
            bmesh.ops.reverse_faces(edited, faces=list(edited.faces)[:50])
        elif edit == "subdivide":
            bmesh.ops.subdivide_edges(edited, edges=list(edited.edges), cuts=1, use_grid_fill=True)
        else:
            bmesh.ops.delete(edited, geom=list(edited.faces)[:9], context="FACES")
        edited.to_mesh(monkey.data)
        edited.free()
    surface = mesh_bridge.read_surface(monkey)
    denoise_object(monkey, settings)
    assert positions(monkey).tobytes() == denoise(surface, settings).vertices.tobytes()
    assert len(counted) == 2


def test_edit_mode_and_object_mode_share_what_is_prepared(monkey, counted):
    noisy = positions(monkey)
    denoise_object(monkey, TRI_2)
    restore(monkey, noisy)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bmesh.from_edit_mesh(monkey.data).verts.ensure_lookup_table()
    denoise_object(monkey, TRI_2)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(counted) == 1
    assert np.abs(positions(monkey) - noisy).max() > 0


def test_loading_a_file_frees_the_memory(monkey):
    denoise_object(monkey, TRI_2)
    assert len(preparations.preparations()) == 1
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert len(preparations.preparations()) == 0
