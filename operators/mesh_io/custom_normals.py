# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Custom normals of meshes whose vertices move, so that noise does not come back as shading.

Blender keeps most custom normals as differences to the normals of the surface, and these may be noise: of
a scan that is shaded by the normals of a clean model, or whose normals were found by another program. So
normals that fit the result better than the input stay as directions. Normals that are those of the noisy
surface, as they differ from them less than the run turned these, become those of the result. All others
follow. Where a seam splits a mesh, as in every GLB, vertices at the same place with the same normal are
shaded as one, and stay so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

SAME = 1e-3
"""Directions that differ by less are the same: Blender keeps them in 16 bits."""

ONE = 1e-2
"""Normals at the sides of a seam that differ by less, as a chord, are one: they were rounded on each side."""


def read_normals(mesh: bpy.types.Mesh) -> NDArray[np.float32] | None:
    """Return the custom normals of all corners, shape (C, 3); None without any, and in Edit Mode."""
    import numpy as np

    if mesh.is_editmode or not mesh.has_custom_normals:
        return None
    normals = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", normals.reshape(-1))
    return normals


def write_normals(mesh: bpy.types.Mesh, normals: NDArray[np.floating]) -> None:
    """Write the custom normals of all corners, shape (C, 3)."""
    import numpy as np

    attribute = mesh.attributes.get("custom_normal")
    if attribute is None or attribute.data_type != "FLOAT_VECTOR":
        mesh.normals_split_custom_set(normals)
        return
    # These are kept as directions, which Blender's function for normals does not know of.
    if attribute.domain != "CORNER":
        mesh.attributes.remove(attribute)
        attribute = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    attribute.data.foreach_set("vector", np.ascontiguousarray(normals, np.float32).reshape(-1))
    mesh.update()


def fit_better_after(normals: NDArray[np.float32], before: SurfaceMesh, after: NDArray[np.floating]) -> bool:
    """Tell whether custom normals, shape (C, 3), fit a mesh better after its vertices moved.

    Parameters
    ----------
    normals : ndarray, shape (C, 3)
        The normals of the corners before.
    before : SurfaceMesh
        The mesh before.
    after : ndarray, shape (N, 3)
        Its positions afterwards.
    """
    old, new = _smooth_normals(normals, before, after)
    return bool(_angle(normals, new) < _angle(normals, old))


def stay_noisy(
    mesh: bpy.types.Mesh, normals: NDArray[np.float32], before: SurfaceMesh, after: NDArray[np.floating]
) -> bool:
    """Tell whether custom normals, shape (C, 3), bring noise back where a modifier moves the vertices.

    They do if they are those of the noisy surface and are kept as directions, or shade split vertices as one:
    then what is kept is how they differ from the noisy normals at the sides of the seam.
    Takes what `settle_normals` takes, before the vertices of the mesh are moved.
    """
    import numpy as np

    attribute = mesh.attributes.get("custom_normal")
    are_directions = attribute is not None and attribute.data_type == "FLOAT_VECTOR"
    corner = before.corner_vertex
    if not are_directions and np.array_equal(_shaded_as_one(normals, before)[corner], corner):
        return False
    old, new = _smooth_normals(normals, before, after)
    return _angle(normals, old) < _angle(old, new)


def settle_normals(
    mesh: bpy.types.Mesh, normals: NDArray[np.float32], before: SurfaceMesh, after: NDArray[np.floating]
) -> str:
    """Bring the custom normals of a mesh in order, whose vertices were just moved.

    Parameters
    ----------
    mesh : bpy.types.Mesh
        The mesh, with its new positions.
    normals : ndarray, shape (C, 3)
        What `read_normals` returned before.
    before : SurfaceMesh
        The mesh before.
    after : ndarray, shape (N, 3)
        Its new positions.

    Returns
    -------
    str
        KEPT if they stay as directions, RENEWED if they are those of the result, empty if they follow.
    """
    import numpy as np

    old, new = _smooth_normals(normals, before, after)
    if _angle(normals, new) < _angle(normals, old):
        write_normals(mesh, normals)
        return "KEPT"
    if _angle(normals, old) < _angle(old, new):
        write_normals(mesh, new)
        return "RENEWED"
    now = read_normals(mesh)
    if now is not None and np.abs(now - normals).max() < SAME:
        write_normals(mesh, _turned(normals, old, new))  # nobody else turns directions
    return ""


def _smooth_normals(
    normals: NDArray[np.float32], before: SurfaceMesh, after: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the normals of the surface before and after at all corners, shape (C, 3) each.

    Vertices that the custom normals, shape (C, 3), shade as one have one normal.
    """
    from ...core.mesh.geometry import vertex_normals
    from ...core.mesh.surface_mesh import SurfaceMesh

    corner = _shaded_as_one(normals, before)[before.corner_vertex]
    joined = SurfaceMesh.trusted(
        before.vertices, corner, before.corner_edge, before.face_offset, before.edges
    )
    old, new = vertex_normals(joined), vertex_normals(joined.with_vertices(after))
    return old[corner], new[corner]


def _shaded_as_one(normals: NDArray[np.float32], surface: SurfaceMesh) -> NDArray[np.int32]:
    """Return for each vertex the first one at its place, shape (N,), or itself if their normals differ."""
    import numpy as np

    from ...core.mesh.weld import same_places

    place = same_places(surface.vertices)
    corner_place = place[surface.corner_vertex]
    n_places = int(place.max(initial=-1)) + 1
    counts = np.maximum(np.bincount(corner_place, minlength=n_places), 1)
    means = [np.bincount(corner_place, normals[:, axis], n_places) / counts for axis in range(3)]
    # The mean of unit vectors is as much shorter than one as they differ.
    is_one = 1.0 - np.square(means).sum(axis=0) < ONE**2
    first = np.unique(place, return_index=True)[1]
    return np.where(is_one[place], first[place], np.arange(surface.n_vertices)).astype(np.int32)


def _angle(first: NDArray[np.floating], second: NDArray[np.floating]) -> float:
    """Return the mean angle between unit vectors, shape (C, 3) each, in degrees."""
    import numpy as np

    from ...core.metrics import normal_angles

    return float(np.nan_to_num(normal_angles(first, second)).mean())


def _turned(
    normals: NDArray[np.floating], old: NDArray[np.float64], new: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return vectors turned as others turned, shape (C, 3) each."""
    import numpy as np

    cosine = (old * new).sum(axis=1, keepdims=True)
    axis = np.cross(old, new)
    along = (axis * normals).sum(axis=1, keepdims=True)
    turned = normals * cosine + np.cross(axis, normals) + axis * along / np.maximum(1.0 + cosine, 1e-6)
    return turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-30)
