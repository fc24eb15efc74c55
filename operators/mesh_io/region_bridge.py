# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What limits a run to parts of an object: selection, hidden faces, masks, a vertex group, sharp edges."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from ..properties.scene_units import linear_part
from . import mesh_bridge
from .face_sets import vertices_of_face_set
from .shape_keys import active_key
from .typed_attributes import truth_values, typed_values

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import Region, SurfaceMesh
    from ..properties.region_options import RegionOptions

SELECTED = ".select_vert"
HIDDEN = ".hide_vert"
HIDDEN_FACE = ".hide_poly"
MASK = ".sculpt_mask"
SHARP = "sharp_edge"
CREASE = "crease_edge"
"""Blender's names of attributes, which it leaves away where all values are false or 0."""


class RegionRead(NamedTuple):
    """A mesh and what may move of it: a mask of shape (N,), or None for all, and the other limits."""

    surface: SurfaceMesh
    movable: NDArray[np.bool_] | None
    region: Region


def read_region(obj: bpy.types.Object, options: RegionOptions) -> RegionRead:
    """Read the mesh of an object, and what a run may change of it.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in one of `mesh_bridge.MODES`; its active shape key is read.
    options : RegionOptions
        What the user asks for.

    Raises
    ------
    ValueError
        With a sentence that names the object, if it has no such vertex group, or if nothing may move.
    """
    from ...core.mesh.borders import border_vertices
    from ...core.mesh.geometry import mean_edge_length

    is_edited = obj.data.is_editmode
    with mesh_bridge.readable_mesh(obj) as mesh:
        surface = mesh_bridge.read_arrays(mesh, None if is_edited else active_key(obj))
        movable = _movable(obj, mesh, surface, is_edited, options)
        if options.face_set:
            movable = _in_face_set(obj, mesh, surface, options.face_set, movable)
        # In Edit Mode the selection says what moves; a mask is not seen there.
        free = _unmasked(mesh) if options.keep_mask and not is_edited else None
        sharp = _sharp_edges(mesh, surface) if options.keep_sharp else None
    weights = None
    if options.vertex_group:
        weights = mesh_bridge.read_weights(obj, options.vertex_group)
        moves = weights < 1.0 if options.invert_group else weights > 0.0
        if not (moves if movable is None else moves & movable).any():
            inverted = ", inverted," if options.invert_group else ""
            which = "vertices" if movable is None else "vertices that may move"
            raise ValueError(
                f"The vertex group ‘{options.vertex_group}’{inverted} of ‘{obj.name}’ gives no weight to any "
                f"of its {which}; give them weights, or choose another group."
            )
    if free is not None:
        moves = free > 0.0 if movable is None else movable & (free > 0.0)
        if not moves.any():
            raise ValueError(
                f"All vertices of ‘{obj.name}’ that may move are masked; clear the mask where it should be "
                "denoised, or turn off Sculpt Mask."
            )
    edge = mean_edge_length(surface) if options.limit == "EDGES" else 0.0
    border = border_vertices(surface) if options.weld else None
    region = options.region(edge, _largest_scale(obj), weights, sharp, border)
    if free is not None:
        region = replace(region, weights=free if region.weights is None else region.weights * free)
    return RegionRead(surface, movable, region)


def _movable(
    obj: bpy.types.Object, mesh: bpy.types.Mesh, surface: SurfaceMesh, is_edited: bool, options: RegionOptions
) -> NDArray[np.bool_] | None:
    """Return which vertices may move; None for all."""
    hidden = truth_values(mesh, HIDDEN)
    if is_edited:
        # In Edit Mode hidden vertices are not selected.
        movable = truth_values(mesh, SELECTED) & ~hidden
        if not movable.any():
            raise ValueError(
                f"‘{obj.name}’ has no selected vertices; select what should be denoised or measured."
            )
        return movable
    if options.keep_hidden:
        hidden[_vertices_of_hidden_faces(mesh, surface)] = True
    if not options.keep_hidden or not hidden.any():
        return None
    if hidden.all():
        raise ValueError(
            f"All vertices of ‘{obj.name}’ are hidden; reveal some, or turn off Leave Hidden Alone."
        )
    return ~hidden


def _in_face_set(
    obj: bpy.types.Object,
    mesh: bpy.types.Mesh,
    surface: SurfaceMesh,
    number: int,
    movable: NDArray[np.bool_] | None,
) -> NDArray[np.bool_]:
    """Return which of the vertices that may move are of a face set."""
    inside = vertices_of_face_set(obj, mesh, surface, number)
    if movable is None:
        return inside
    if not (inside & movable).any():
        raise ValueError(
            f"No vertex of face set {number} of ‘{obj.name}’ may move; choose another set, or reveal or "
            "select some of its vertices."
        )
    return inside & movable


def _vertices_of_hidden_faces(mesh: bpy.types.Mesh, surface: SurfaceMesh) -> NDArray[np.int32]:
    """Return the corners of hidden faces, as vertices, so that nothing changes that is not seen."""
    import numpy as np

    hidden = truth_values(mesh, HIDDEN_FACE, "FACE")
    return surface.corner_vertex[np.repeat(hidden, np.diff(surface.face_offset))]


def _unmasked(mesh: bpy.types.Mesh) -> NDArray[np.float64] | None:
    """Return one minus the sculpt mask, shape (N,), from 0 to 1; None where nothing is masked."""
    import numpy as np

    mask = typed_values(mesh, MASK, "FLOAT", "POINT")
    return 1.0 - np.clip(mask.astype(np.float64), 0.0, 1.0) if mask.any() else None


def _sharp_edges(mesh: bpy.types.Mesh, surface: SurfaceMesh) -> NDArray[np.int32]:
    """Return the edges that are marked sharp or creased, shape (E, 2)."""
    is_sharp = truth_values(mesh, SHARP, "EDGE")
    is_sharp |= typed_values(mesh, CREASE, "FLOAT", "EDGE") > 0.0
    return surface.edges[is_sharp]


def _largest_scale(obj: bpy.types.Object) -> float:
    """Return the largest scale of an object, so that no length in the scene is exceeded in any direction.

    Raises
    ------
    ValueError
        With a sentence that names the object, if that is not finite.
    """
    import numpy as np

    linear = linear_part(obj)
    if not np.isfinite(linear).all():
        raise ValueError(
            f"The rotation or scale of ‘{obj.name}’ is not finite; set or clear it (Object > Clear)."
        )
    return float(np.linalg.norm(linear, 2))
