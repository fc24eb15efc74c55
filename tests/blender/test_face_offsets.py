# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""First corners of faces, read as an array, are those that the faces tell; doubtful arrays are not read."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from framelet.operators import face_offsets
from framelet.operators.face_offsets import read_face_starts
from framelet.operators.mesh_io import mesh_bridge

SIZES = (3, 4, 5, 3, 3, 8, 4)


@pytest.fixture(autouse=True)
def always(monkeypatch):
    """Read small meshes as large ones are read."""
    monkeypatch.setattr(face_offsets, "MANY_FACES", 1)


@pytest.fixture
def asked(monkeypatch):
    """Note what is asked face by face."""
    calls = []
    original = face_offsets._address_of_starts

    def address_of_starts(mesh):
        found = original(mesh)
        calls.append(found is None)
        return found

    monkeypatch.setattr(face_offsets, "_address_of_starts", address_of_starts)
    return calls


def ngons(sizes):
    """Return a mesh of loose faces with so many corners."""
    faces, start = [], 0
    for size in sizes:
        faces.append(range(start, start + size))
        start += size
    mesh = bpy.data.meshes.new("Faces")
    mesh.from_pydata(np.random.default_rng(0).normal(size=(start, 3)).tolist(), [], faces)
    return mesh


def starts_of(mesh):
    starts = np.full(len(mesh.polygons), -7, np.int32)
    read_face_starts(mesh, starts)
    return starts.tolist()


@pytest.mark.parametrize("n_faces", [1, 2, 3, 16, 17, 1000])
def test_starts_are_those_that_the_faces_tell(n_faces, asked, rng):
    mesh = ngons(rng.integers(3, 9, n_faces))
    assert starts_of(mesh) == [face.loop_start for face in mesh.polygons]
    assert asked == [False], "read as an array"


def test_starts_follow_edits_of_the_same_mesh(asked):
    """Also where as many faces have as many corners, and where the mesh shares its arrays with a copy."""
    mesh = ngons(SIZES)
    copy = mesh.copy()
    expected = np.cumsum((0, *SIZES))[:-1].tolist()
    assert starts_of(mesh) == starts_of(copy) == expected
    mesh.polygons.foreach_set("loop_start", np.cumsum((0, *SIZES[::-1]))[:-1].astype(np.int32))
    assert starts_of(mesh) == np.cumsum((0, *SIZES[::-1]))[:-1].tolist()
    assert starts_of(copy) == expected
    mesh.clear_geometry()
    other = ngons((4,) * 9)
    mesh.from_pydata([v.co for v in other.vertices], [], [f.vertices for f in other.polygons])
    assert starts_of(mesh) == list(range(0, 36, 4))
    assert asked and not any(asked)


def test_surfaces_have_all_offsets(empty_scene):
    obj = bpy.data.objects.new("Faces", ngons(SIZES))
    bpy.context.collection.objects.link(obj)
    assert mesh_bridge.read_surface(obj).face_offset.tolist() == np.cumsum((0, *SIZES)).tolist()


class Faces(list):
    """Faces of a made-up mesh."""

    def foreach_get(self, name, values):
        values[:] = [getattr(face, name) for face in self]


def made_up(numbers, step=4, told=None):
    """Return a mesh whose faces say they lie `step` bytes apart, where an array has `numbers`."""
    array = np.array(numbers, np.int32)
    told = numbers if told is None else told
    faces = Faces(
        SimpleNamespace(as_pointer=lambda at=array.ctypes.data + step * k: at, loop_start=told[k])
        for k in range(len(told))
    )
    return SimpleNamespace(polygons=faces, array=array)


def test_what_lies_otherwise_is_asked_face_by_face(asked):
    numbers = list(range(0, 300, 3))
    assert starts_of(made_up(numbers)) == numbers
    assert starts_of(made_up(numbers, step=8)) == numbers
    assert starts_of(made_up([0] * 100, step=0, told=numbers)) == numbers
    for wrong in (0, 1, 99):
        other = numbers.copy()
        other[wrong] += 1
        assert starts_of(made_up(other, told=numbers)) == numbers
    assert asked == [False, True, True, True, True, True]
