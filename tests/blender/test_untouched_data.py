# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators change positions and nothing else: every other byte of a mesh stays, in both modes."""

import bpy
import numpy as np
import pytest
from framelet.operators.mesh_io.custom_normals import read_normals

# isort: split
# This module exists once bpy was imported.
import bmesh

ITEM_FIELDS = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "INT16_2D": ("value", np.int32, 2),
    "INT32_2D": ("value", np.int32, 2),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
}
CUSTOM_TYPES = (
    "FLOAT",
    "INT",
    "BOOLEAN",
    "FLOAT2",
    "FLOAT_VECTOR",
    "FLOAT_COLOR",
    "BYTE_COLOR",
    "QUATERNION",
)


def attribute_bytes(mesh):
    """Return every attribute of a mesh as bytes, but not the positions."""
    state = {}
    for attribute in mesh.attributes:
        if attribute.name == "position" or attribute.data_type == "STRING":
            continue
        field, dtype, width = ITEM_FIELDS[attribute.data_type]
        values = np.empty(len(attribute.data) * width, dtype)
        attribute.data.foreach_get(field, values)
        state[attribute.name, attribute.domain, attribute.data_type] = values.tobytes()
    return state


def snapshot(obj):
    """Return everything about an object's mesh that must stay."""
    mesh = obj.data
    return {
        "attributes": attribute_bytes(mesh),
        "weights": [[(item.group, item.weight) for item in vertex.groups] for vertex in mesh.vertices],
        "groups": [group.name for group in obj.vertex_groups],
        "materials": [material and material.name for material in mesh.materials],
        "uv_layers": [(layer.name, layer.active, layer.active_render) for layer in mesh.uv_layers],
        "colors": (mesh.color_attributes.active_color_name, mesh.color_attributes.render_color_index),
        "marks": [(edge.use_seam, edge.use_edge_sharp, edge.select, edge.hide) for edge in mesh.edges],
        "faces": [(face.material_index, face.use_smooth, face.select, face.hide) for face in mesh.polygons],
        "verts": [(vertex.select, vertex.hide) for vertex in mesh.vertices],
        "strings": [
            [item.value for item in attribute.data]
            for attribute in mesh.attributes
            if attribute.data_type == "STRING"
        ],
        "modifiers": [(modifier.type, modifier.name) for modifier in obj.modifiers],
        "names": (obj.name, mesh.name),
    }


def fill(attribute, rng):
    field, dtype, width = ITEM_FIELDS[attribute.data_type]
    n_values = len(attribute.data) * width
    if dtype is bool:
        values = rng.random(n_values) < 0.5
    elif dtype == np.int32:
        values = rng.integers(0, 2, n_values).astype(np.int32)
    else:
        values = rng.random(n_values).astype(np.float32)
    attribute.data.foreach_set(field, values)


@pytest.fixture
def rich_object(rng):
    """Give an object with data of every kind on its mesh."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=9)
    obj = bpy.context.object
    bpy.ops.object.framelet_add_noise()
    mesh = obj.data
    for domain in ("POINT", "EDGE", "FACE", "CORNER"):
        for kind in CUSTOM_TYPES:
            fill(mesh.attributes.new(f"{kind} on {domain}", kind, domain), rng)
    for name in ("crease_edge", "bevel_weight_edge"):
        fill(mesh.attributes.new(name, "FLOAT", "EDGE"), rng)
    for name in ("crease_vert", "bevel_weight_vert"):
        fill(mesh.attributes.new(name, "FLOAT", "POINT"), rng)
    for layer in (mesh.uv_layers.new(name="Second"), mesh.uv_layers[0]):
        layer.uv.foreach_set("vector", rng.random(2 * len(mesh.loops)).astype(np.float32))
    for name in ("Stone", "Moss"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", rng.integers(0, 2, len(mesh.polygons)).astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", rng.random(len(mesh.polygons)) < 0.5)
    mesh.edges.foreach_set("use_seam", rng.random(len(mesh.edges)) < 0.3)
    mesh.edges.foreach_set("use_edge_sharp", rng.random(len(mesh.edges)) < 0.3)
    for name in ("Left", "Right"):
        group = obj.vertex_groups.new(name=name)
        for index in range(0, len(mesh.vertices), 2):
            group.add([index], float(np.float32(rng.random())), "REPLACE")
    obj.modifiers.new("Subdivision", "SUBSURF")
    return obj


def select_part(obj):
    """Select a part of the vertices, hide others; ends in Edit Mode."""
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    for vert in edit_mesh.verts:
        vert.select_set(vert.index % 3 != 0)
    edit_mesh.select_flush_mode()
    for vert in list(edit_mesh.verts)[:10]:
        vert.hide_set(True)
    bmesh.update_edit_mesh(obj.data)


OPERATORS = [
    ("framelet_denoise", {}),
    ("framelet_add_noise", {"sigma": 0.3}),
    ("framelet_equalize", {"gain_1": 0.0, "gain_2": 2.0}),
]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize(("operator", "values"), OPERATORS, ids=[name for name, _ in OPERATORS])
def test_only_positions_change(rich_object, operator, values, mode):
    obj = rich_object
    select_part(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    # Edit Mode itself may rewrite attributes, so that the state after one more visit is what counts.
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    before = snapshot(obj)
    positions = [tuple(vertex.co) for vertex in obj.data.vertices]
    bpy.ops.object.mode_set(mode=mode)
    assert getattr(bpy.ops.object, operator)(**values) == {"FINISHED"}
    assert obj.mode == mode
    bpy.ops.object.mode_set(mode="OBJECT")
    after = snapshot(obj)
    assert after["attributes"].keys() == before["attributes"].keys()
    for name, values_before in before["attributes"].items():
        assert after["attributes"][name] == values_before, name
    assert after == before
    moved = [tuple(vertex.co) != old for vertex, old in zip(obj.data.vertices, positions, strict=True)]
    assert any(moved)
    if mode == "EDIT":
        for is_moved, vertex in zip(moved, obj.data.vertices, strict=True):
            assert not is_moved or (vertex.select and not vertex.hide)


def test_custom_normals_stay(rich_object):
    mesh = rich_object.data
    mesh.normals_split_custom_set([(0.0, 0.6, 0.8)] * len(mesh.loops))
    before, directions = attribute_bytes(mesh), read_normals(mesh)
    assert any(name == "custom_normal" for name, _, _ in before) or mesh.has_custom_normals
    bpy.ops.object.framelet_denoise()
    after = attribute_bytes(mesh)
    changed = {key for key in before | after if before.get(key) != after.get(key)}
    # They follow the surface as they are, or keep their directions where these fit the result better.
    assert {name for name, _, _ in changed} <= {"custom_normal"}
    assert not changed or np.abs(read_normals(mesh) - directions).max() < 0.02  # they have 16 bits
