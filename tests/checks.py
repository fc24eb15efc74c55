# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assertions and small measures that several tests share."""

from dataclasses import fields

import numpy as np
from framelet.core import PRESETS, Region
from framelet.core.frames import BANKS
from framelet.core.mesh.edge_list import find_edges
from framelet.core.mesh.surface_mesh import SurfaceMesh
from framelet.core.settings import used_settings

AS_SOLVED = Region(repair_folds=False)
"""Leaves the result of a solver as it is, for comparisons with twins and for figures of the methods."""

TRIANGLE_PRESETS = ("TRI_1", "TRI_2", "BILATERAL")
"""The presets that serve any mesh by triangle stencils, or by none."""

TRIANGLE_BANKS = {name: BANKS[name] for name in ("BOX_SPLINE_111", "BOX_SPLINE_111_CANONICAL")}
"""The banks with the seven taps of a triangle stencil."""


def wild_mesh(vertices, faces, loose_edges=()):
    """Return a mesh of faces that the constructors may refuse: of two corners or less, or a vertex twice.

    Other programs keep such faces, and so all methods have to cope with them.
    """
    vertices = np.asarray(vertices)
    vertices = vertices if vertices.dtype == np.float32 else vertices.astype(np.float64)
    flat = np.array([int(v) for face in faces for v in face], np.int32)
    offset = np.concatenate(([0], np.cumsum([len(face) for face in faces]))).astype(np.int32)
    bare = SurfaceMesh.trusted(vertices, flat, flat, offset, np.zeros((0, 2), np.int32))
    loose = np.asarray(loose_edges, np.int64).reshape(-1, 2)
    edges, corner_edge = find_edges(flat, flat[bare.next_corner()], loose, len(vertices))
    return SurfaceMesh.trusted(vertices, flat, corner_edge, offset, edges)


def preset_settings(preset, **changes):
    """Return the settings of a preset, with those of the changes that its method uses."""
    settings = PRESETS[preset].settings
    return settings.with_changes(**used_settings({"method": settings.method} | changes))


def read_only(mesh):
    """Return a copy of a mesh whose arrays refuse to be written to."""
    arrays = {}
    for item in fields(SurfaceMesh):
        arrays[item.name] = getattr(mesh, item.name).copy()
        arrays[item.name].flags.writeable = False
    return SurfaceMesh.trusted(**arrays)


def assert_same_bits(first, second):
    """Fail unless two arrays have the same dtype, shape and bits; -0.0 differs from 0.0."""
    assert first.dtype == second.dtype
    assert first.shape == second.shape
    different = np.flatnonzero(first.view(f"u{first.itemsize}") != second.view(f"u{second.itemsize}"))
    assert not len(different), f"{len(different)} values differ in their bits"


def edge_length(mesh):
    """Return the mean edge length over face-edge incidences, by a loop."""
    lengths = []
    for begin, end in zip(mesh.face_offset[:-1], mesh.face_offset[1:], strict=True):
        face = mesh.vertices[mesh.corner_vertex[begin:end]].astype(np.float64)
        lengths += [np.linalg.norm(face[k] - face[k - 1]) for k in range(len(face))]
    return float(np.mean(lengths))


def random_rotation(rng):
    """Return a random rotation matrix."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def lengths(vectors):
    """Return the Euclidean length of each row."""
    return np.linalg.norm(np.asarray(vectors, np.float64), axis=-1)
