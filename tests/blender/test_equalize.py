# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The equalizer does what core does, to the right vertices by the right weights."""

import bpy
import meshes
import numpy as np
import pytest

# isort: split
# This module exists once bpy was imported.
import bmesh
from blender_objects import noisy_monkey, read
from framelet.core import SurfaceMesh, connect, equalize, make_transform
from framelet.operators.equalize import equalize_object
from framelet.operators.mesh_io import mesh_bridge
from framelet.operators.properties.band_settings import GAIN_NAMES


def add_group(obj, name="Group"):
    """Add a group with weights from 0 to 1 on every other vertex, and return the weights."""
    weights = np.zeros(len(obj.data.vertices))
    group = obj.vertex_groups.new(name=name)
    for index in range(0, len(weights), 2):
        weights[index] = np.float32(index / len(weights))
        group.add([index], weights[index], "REPLACE")
    return weights


@pytest.mark.parametrize("gains", [(0.0,), (0.5, 1.0, 2.0), (1.5, 0.3), (3, 3, 3, 3)])
def test_operator_equals_core(gains):
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    expected = equalize(surface, gains, stencil="MEAN", frame="ADAPTIVE", boundary="FREE")
    values = {f"gain_{level}": gain for level, gain in enumerate(gains, 1)}
    result = bpy.ops.object.framelet_equalize(
        levels=len(gains), stencil="MEAN", frame="ADAPTIVE", boundary="FREE", **values
    )
    assert result == {"FINISHED"}
    assert read(obj).tobytes() == expected.tobytes()


def test_gains_of_one_change_no_bit():
    obj = noisy_monkey()
    before = read(obj)
    assert bpy.ops.object.framelet_equalize() == {"FINISHED"}
    assert read(obj).tobytes() == before.tobytes()


def test_only_gains_of_levels_in_use_count():
    obj = noisy_monkey()
    before = read(obj)
    bpy.ops.object.framelet_equalize(levels=2, gain_3=0.0)
    assert read(obj).tobytes() == before.tobytes()


def test_gain_zero_at_level_one_smooths(make_object, rng):
    clean = meshes.triangle_torus(24, 32)
    obj = make_object(meshes.noisy(clean, rng, 0.1))
    noisy = mesh_bridge.read_surface(obj)
    bpy.ops.object.framelet_equalize(levels=1, gain_1=0.0)

    def roughness(vertices):
        surface = noisy.with_vertices(vertices.astype(np.float64))
        transform = make_transform(surface, "BOX_SPLINE_111", connectivity=connect(surface))
        # Second differences; the other bands also see the slope of the surface.
        return np.abs(transform.analyze(surface.vertices).details(0)[:3]).mean()

    assert roughness(read(obj)) < 0.6 * roughness(noisy.vertices)
    assert np.abs(read(obj) - clean.vertices).mean() < np.abs(noisy.vertices - clean.vertices).mean()


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("invert", [False, True])
def test_vertex_groups_weigh_the_change(invert, mode):
    obj = noisy_monkey()
    add_group(obj, "Other")
    weights = add_group(obj)
    surface = mesh_bridge.read_surface(obj)
    full = equalize(surface, (0.0, 2.0)).astype(np.float64) - surface.vertices
    share = 1.0 - weights if invert else weights
    bpy.ops.object.mode_set(mode=mode)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.framelet_equalize(levels=2, gain_1=0.0, gain_2=2.0, vertex_group="Group", invert=invert)
    after = read(obj)
    assert np.allclose(after - surface.vertices, share[:, None] * full, atol=1e-6)
    still = share == 0
    assert still.any() != invert
    assert after[still].tobytes() == surface.vertices[still].tobytes()


def test_edit_mode_moves_selected_visible_vertices_only():
    obj = noisy_monkey()
    surface = mesh_bridge.read_surface(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    edit_mesh = bmesh.from_edit_mesh(obj.data)
    movable = np.arange(surface.n_vertices) % 3 == 0
    for vert in edit_mesh.verts:
        vert.select = bool(movable[vert.index])
    edit_mesh.verts.ensure_lookup_table()
    edit_mesh.verts[3].hide = True
    movable[3] = False
    expected = equalize(surface, (0.0,))
    bpy.ops.object.framelet_equalize(levels=1, gain_1=0.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    after = read(obj)
    assert np.allclose(after[movable], expected[movable], atol=1e-7)
    assert (after[movable] != surface.vertices[movable]).any()
    assert after[~movable].tobytes() == surface.vertices[~movable].tobytes()


def test_the_active_shape_key_is_equalized():
    obj = noisy_monkey()
    basis = obj.shape_key_add(name="Basis")
    smile = obj.shape_key_add(name="Smile")
    obj.active_shape_key_index = 1
    wide = read(obj) * np.float32([2, 1, 1])
    smile.data.foreach_set("co", wide.reshape(-1))
    basis_before = [tuple(point.co) for point in basis.data]
    expected = equalize(mesh_bridge.read_surface(obj), (0.0,))
    bpy.ops.object.framelet_equalize(levels=1, gain_1=0.0)
    assert read(obj).tobytes() == expected.tobytes()
    assert [tuple(point.co) for point in basis.data] == basis_before


def test_all_selected_meshes_are_equalized(capfd):
    objects = [noisy_monkey("A"), noisy_monkey("B"), noisy_monkey("C")]
    before = [read(obj) for obj in objects]
    add_group(objects[0])
    add_group(objects[2])
    for obj in objects:
        obj.select_set(True)
    assert bpy.ops.object.framelet_equalize(gain_1=0.0, vertex_group="Group") == {"FINISHED"}
    changed = [read(obj).tobytes() != old.tobytes() for obj, old in zip(objects, before, strict=True)]
    assert changed == [True, False, True]
    output = capfd.readouterr().out
    assert "Warning: ‘B’ has no vertex group ‘Group’" in output
    assert "Equalized 2 objects" in output


def test_undo_restores():
    obj = noisy_monkey()
    before = read(obj)
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.framelet_equalize(gain_1=0.0)
    bpy.ops.ed.undo_push(message="Equalize")
    assert read(bpy.data.objects["Monkey"]).tobytes() != before.tobytes()
    bpy.ops.ed.undo()
    assert read(bpy.data.objects["Monkey"]).tobytes() == before.tobytes()


def refuses(obj, sentence, **values):
    before = read(obj)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.object.framelet_equalize(**values)
    assert read(obj).tobytes() == before.tobytes()


def test_bad_input_gets_a_sentence_and_the_mesh_stays(make_object):
    obj = noisy_monkey()
    refuses(obj, "‘Monkey’ has no vertex group ‘Nothing’; choose one", vertex_group="Nothing")
    small = make_object(meshes.tetrahedron(), "Small")
    refuses(small, "‘Small’: The mesh is too small for 2 levels")
    empty = make_object(SurfaceMesh.from_faces(np.eye(3), np.zeros((0, 3), int)), "Empty")
    refuses(empty, "‘Empty’ has no faces")


@pytest.mark.parametrize(
    ("gains", "sentence"),
    [
        ((), "There are no gains"),
        ((1.0, float("nan")), "The gain of level 2 is nan"),
        ((-1.0,), "it must be"),
    ],
)
def test_bad_gains_get_a_sentence(gains, sentence):
    obj = noisy_monkey()
    before = read(obj)
    with pytest.raises(ValueError, match=f"‘Monkey’: .*{sentence}"):
        equalize_object(obj, gains)
    assert read(obj).tobytes() == before.tobytes()


def test_the_operator_never_writes_what_is_not_a_number():
    obj = noisy_monkey()
    try:
        bpy.ops.object.framelet_equalize(gain_1=float("nan"))
    except RuntimeError as error:
        assert "The gain of level 1 is nan" in str(error)
    assert np.isfinite(read(obj)).all()


def test_nothing_selected_in_edit_mode_gets_a_sentence():
    noisy_monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="‘Monkey’ has no selected vertices"):
        bpy.ops.object.framelet_equalize(gain_1=0.0)


def test_gains_are_properties_with_words():
    properties = bpy.ops.object.framelet_equalize.get_rna_type().properties
    assert len(GAIN_NAMES) == properties["levels"].hard_max == 6
    for name in GAIN_NAMES:
        item = properties[name]
        assert (item.default, item.hard_min, item.soft_max) == (1.0, 0.0, 3.0)
        assert len(item.description) > 20
