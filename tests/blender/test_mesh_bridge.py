# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays come out of Blender and go back as they should, in both modes and with shape keys."""

import bpy
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
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


@pytest.fixture(params=["OBJECT", "EDIT"])
def mode(request):
    return request.param


def check_arrays(surface, mesh):
    assert surface.vertices.dtype == np.float32
    for array in (surface.corner_vertex, surface.corner_edge, surface.face_offset, surface.edges):
        assert array.dtype == np.int32
    assert np.array_equal(surface.vertices, positions(mesh))
    assert surface.corner_vertex.tolist() == [loop.vertex_index for loop in mesh.loops]
    assert surface.corner_edge.tolist() == [loop.edge_index for loop in mesh.loops]
    assert surface.face_offset[:-1].tolist() == [face.loop_start for face in mesh.polygons]
    assert surface.face_offset[-1] == len(mesh.loops)
    assert surface.edges.tolist() == [list(edge.vertices) for edge in mesh.edges]


def test_reads_triangles_quads_and_ngons(mode):
    bpy.ops.mesh.primitive_cone_add(vertices=7)
    bpy.ops.mesh.primitive_cube_add(location=(3, 0, 0))
    obj = bpy.context.object
    for each in bpy.context.scene.objects:
        each.select_set(True)
    bpy.ops.object.join()
    bpy.ops.object.mode_set(mode=mode)
    surface = mesh_bridge.read_surface(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert set(surface.face_sizes()) == {3, 4, 7}
    check_arrays(surface, obj.data)


def test_reads_loose_parts(mode):
    mesh = bpy.data.meshes.new("Loose")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 5, 5), (6, 5, 5)], [(3, 4)], [(0, 1, 2)])
    obj = bpy.data.objects.new("Loose", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode=mode)
    surface = mesh_bridge.read_surface(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert surface.n_edges == 4
    check_arrays(surface, mesh)


def test_reads_the_state_of_the_edit_session():
    obj = sphere()
    bpy.ops.object.mode_set(mode="EDIT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    edit_mesh.verts.ensure_lookup_table()
    edit_mesh.verts[5].co = (7, 8, 9)
    n_meshes = len(bpy.data.meshes)
    assert mesh_bridge.read_surface(obj).vertices[5].tolist() == [7, 8, 9]
    assert len(bpy.data.meshes) == n_meshes


def test_movable_is_selected_and_visible():
    obj = sphere()
    assert mesh_bridge.read_surface_and_movable(obj)[1] is None
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    edit_mesh.verts.ensure_lookup_table()
    for index in (1, 2, 3):
        edit_mesh.verts[index].select = True
    edit_mesh.verts[2].hide = True
    movable = mesh_bridge.read_surface_and_movable(obj)[1]
    assert np.flatnonzero(movable).tolist() == [1, 3]


def test_writes_back_only_what_moved(mode, rng):
    obj = sphere()
    before = positions(obj.data)
    bpy.ops.object.mode_set(mode=mode)
    surface = mesh_bridge.read_surface(obj)
    vertices, moved = move_some(surface, rng)
    unsigned = ~moved & (vertices[:, 0] == 0)
    vertices[unsigned, 0] = -0.0
    mesh_bridge.write_vertices(obj, surface, vertices)
    assert np.array_equal(mesh_bridge.read_surface(obj).vertices, vertices)
    bpy.ops.object.mode_set(mode="OBJECT")
    after = positions(obj.data)
    assert after[moved].tobytes() == vertices[moved].tobytes()
    assert after[~moved].tobytes() == before[~moved].tobytes()
    assert surface.vertices.tobytes() == before.tobytes(), "the input was changed"


def test_evaluated_mesh_and_normals_follow(mode):
    obj = sphere()
    # Both are computed once before, so that what is cached must be thrown away.
    bpy.context.evaluated_depsgraph_get().update()
    assert obj.data.vertices[0].normal.length > 0
    bpy.ops.object.mode_set(mode=mode)
    surface = mesh_bridge.read_surface(obj)
    stretched = surface.vertices * np.float32([1, 1, 3])
    mesh_bridge.write_vertices(obj, surface, stretched)
    if mode == "EDIT":
        normals = [vert.normal.copy() for vert in bmesh.from_edit_mesh(obj.data).verts]
        bpy.ops.object.mode_set(mode="OBJECT")
    else:
        normals = [vertex.normal.copy() for vertex in obj.data.vertices]
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert np.array_equal(positions(evaluated), stretched)
    fresh = obj.data.copy()
    assert np.allclose(normals, [vertex.normal for vertex in fresh.vertices], atol=1e-5)


def link_rock(tmp_path):
    """Return an object whose mesh is linked from a file."""
    sphere("Rock")
    path = str(tmp_path / "rocks.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["Rock"]
    bpy.context.collection.objects.link(bpy.data.objects["Rock"])
    return bpy.data.objects["Rock"]


def test_refuses_linked_meshes(tmp_path):
    obj = link_rock(tmp_path)
    reason = mesh_bridge.refusal(obj)
    assert reason.startswith("‘Rock’ uses a mesh linked from")
    assert "rocks.blend" in reason and "Make Local" in reason


def test_refuses_overrides(tmp_path):
    obj = link_rock(tmp_path)
    override = obj.override_create(remap_local_usages=True)
    assert "linked" in mesh_bridge.refusal(override)
    override.data = override.data.override_create(remap_local_usages=True)
    assert "override" in mesh_bridge.refusal(override)


def test_accepts_a_mesh_made_local(tmp_path):
    obj = link_rock(tmp_path)
    obj.make_local()
    obj.data.make_local()
    assert mesh_bridge.refusal(bpy.data.objects["Rock"]) is None


def test_refuses_what_is_no_surface():
    assert "no active object" in mesh_bridge.refusal(None)
    bpy.ops.object.light_add(type="POINT")
    assert mesh_bridge.refusal(bpy.context.object).startswith("‘Point’ is not a mesh")
    empty = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    assert mesh_bridge.refusal(empty).startswith("‘Nothing’ has no faces")


def test_refuses_no_faces_in_edit_mode():
    obj = sphere()
    bpy.ops.object.mode_set(mode="EDIT")
    assert mesh_bridge.refusal(obj) is None
    bpy.ops.mesh.delete(type="ONLY_FACE")
    assert "has no faces" in mesh_bridge.refusal(obj)


def test_refuses_other_modes():
    obj = sphere()
    obj.modifiers.new("Hair", "PARTICLE_SYSTEM")
    bpy.ops.object.mode_set(mode="PARTICLE_EDIT")
    assert obj.mode == "PARTICLE_EDIT"
    assert "another mode" in mesh_bridge.refusal(obj)
