# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The active shape key is what is edited, and the others follow as they do in Blender's Edit Mode."""

import bpy
import numpy as np
import pytest
from framelet.operators.mesh_io import mesh_bridge


def sphere(name="Sphere"):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    bpy.context.object.name = name
    return bpy.context.object


def positions(mesh):
    values = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", values.reshape(-1))
    return values


def move_some(surface, rng):
    """Return positions with every third vertex moved, and which ones moved."""
    moved = np.arange(surface.n_vertices) % 3 == 0
    vertices = surface.vertices.copy()
    vertices[moved] += rng.normal(0, 0.1, (moved.sum(), 3)).astype(np.float32)
    return vertices, moved


def add_keys(obj, rng):
    """Add Basis <- A <- B, and C relative to Basis through nothing else."""
    keys = {name: obj.shape_key_add(name=name, from_mix=False) for name in ("Basis", "A", "B", "C")}
    keys["B"].relative_key = keys["A"]
    for name in ("A", "B", "C"):
        points = key_points(keys[name]) + rng.normal(0, 0.1, (len(obj.data.vertices), 3)).astype(np.float32)
        keys[name].data.foreach_set("co", points.reshape(-1))
    return keys


def key_points(key):
    values = np.empty((len(key.data), 3), np.float32)
    key.data.foreach_get("co", values.reshape(-1))
    return values


def key_state(obj):
    state = {key.name: key_points(key) for key in obj.data.shape_keys.key_blocks}
    state["mesh"] = positions(obj.data)
    return state


@pytest.mark.parametrize("is_relative", [True, False])
@pytest.mark.parametrize("active", ["Basis", "A", "B", "C"])
def test_shape_keys_follow_as_in_edit_mode(active, is_relative, rng):
    obj = sphere()
    keys = add_keys(obj, rng)
    obj.data.shape_keys.use_relative = is_relative
    obj.active_shape_key_index = list(keys).index(active)
    before = key_state(obj)
    surface = mesh_bridge.read_surface(obj)
    assert surface.vertices.tobytes() == before[active].tobytes()
    vertices, moved = move_some(surface, rng)

    mesh_bridge.write_vertices(obj, surface, vertices)
    after = key_state(obj)

    for name, points in before.items():
        key = obj.data.shape_keys.key_blocks.get(name)
        if key is not None:
            key.data.foreach_set("co", points.reshape(-1))
    obj.data.vertices.foreach_set("co", before["mesh"].reshape(-1))
    bpy.ops.object.mode_set(mode="EDIT")
    in_edit_mode = mesh_bridge.read_surface(obj)
    assert in_edit_mode.vertices.tobytes() == before[active].tobytes()
    mesh_bridge.write_vertices(obj, in_edit_mode, vertices)
    bpy.ops.object.mode_set(mode="OBJECT")
    expected = key_state(obj)

    assert after[active].tobytes() == vertices.tobytes()
    for name in after:
        assert after[name].tobytes() == expected[name].tobytes(), name
        assert after[name][~moved].tobytes() == before[name][~moved].tobytes(), name
    dependent = {"Basis": {"A", "B", "C"}, "A": {"B"}}.get(active, set()) if is_relative else set()
    changed = {name for name in keys if after[name].tobytes() != before[name].tobytes()}
    assert changed == {active} | dependent


def test_shape_keys_show_in_the_evaluated_mesh(rng):
    obj = sphere()
    keys = add_keys(obj, rng)
    obj.active_shape_key_index = 3
    for name, key in keys.items():
        key.value = float(name == "C")
    surface = mesh_bridge.read_surface(obj)
    bpy.context.evaluated_depsgraph_get().update()
    vertices, _ = move_some(surface, rng)
    mesh_bridge.write_vertices(obj, surface, vertices)
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert np.allclose(positions(evaluated), vertices, atol=1e-6)


def test_refuses_locked_shape_keys(rng):
    obj = sphere()
    keys = add_keys(obj, rng)
    obj.active_shape_key_index = 1
    keys["A"].lock_shape = True
    assert "‘A’" in mesh_bridge.refusal(obj) and "locked" in mesh_bridge.refusal(obj)
    obj.active_shape_key_index = 2
    assert mesh_bridge.refusal(obj) is None
