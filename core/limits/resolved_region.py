# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A region on the mesh that is worked on, which may be welded and renumbered."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import RegionError
from ..mesh.checks import check_positions
from ..mesh.connectivity import Connectivity
from ..mesh.locality import Reordering
from ..mesh.surface_mesh import SurfaceMesh
from ..mesh.weld import Weld, make_weld
from ..mesh.welded_mesh import WeldedMesh
from ..mesh.winding import with_reversed
from ..precision import as_array
from ..value_checks import check_kind
from .region import Region


@dataclass(frozen=True, eq=False)
class ResolvedRegion:
    """What a region says about the vertices of the mesh that is worked on.

    Attributes
    ----------
    region : Region
        The limits of the run.
    original : SurfaceMesh
        The mesh as it was given.
    surface : SurfaceMesh
        The mesh to work on: the same one, or the welded one.
    weld : Weld or None
        How they lie over each other; None if they are the same.
    movable : ndarray, shape (n,), bool, or None
        Vertices of `surface` that may move; None for all.
    weights : ndarray, shape (n,), float64, or None
        Shares of motion; None for 1 everywhere.
    feature_edges : ndarray, shape (E, 2), int, or None
        Pairs of vertices; None for none.
    reordering : Reordering or None
        Other numbers of `surface`, by which the arrays above go.
    """

    region: Region
    original: SurfaceMesh
    surface: SurfaceMesh
    weld: Weld | None
    movable: NDArray[np.bool_] | None
    weights: NDArray[np.float64] | None
    feature_edges: NDArray[np.integer] | None
    reordering: Reordering | None = None

    def renumbered(self, reordering: Reordering | None) -> ResolvedRegion:
        """Return the same with the numbers of a reordering of `surface`, if there is one."""
        if reordering is None:
            return self
        order = reordering.vertex_order
        edges = self.feature_edges
        return replace(
            self,
            movable=None if self.movable is None else self.movable[order],
            weights=None if self.weights is None else self.weights[order],
            feature_edges=None if edges is None else _new_numbers(reordering)[edges],
            reordering=reordering,
        )

    def welded_mesh(self, connectivity: Connectivity, edge: float) -> WeldedMesh:
        """Return the mesh that moves over the mesh that is worked on, in the numbering of the latter.

        Parameters
        ----------
        connectivity : Connectivity
            Neighborhoods of the mesh that is worked on.
        edge : float
            Its mean edge length.

        Returns
        -------
        WeldedMesh
            A welded mesh carries the original in its own numbering, wound alike, any other one itself.
        """
        topology = self.surface if self.reordering is None else self.reordering.surface
        if self.weld is None:
            return WeldedMesh(topology, topology, connectivity, edge)
        original, vertex, face = self.original, self.weld.vertex, self.weld.face
        if self.reordering is not None:
            vertex, face = _new_numbers(self.reordering)[vertex], face[self.reordering.face_order]
            if self.reordering.is_reversed is not None:
                original = with_reversed(original, face[self.reordering.is_reversed])
        return WeldedMesh(original, topology, connectivity, edge, vertex, face)

    def in_given_order(self, vertices: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return positions of the original surface, shape (N, 3), in the numbering of the original."""
        if self.weld is not None or self.reordering is None:
            return vertices
        return self.reordering.vertices_back(vertices)


def resolve(region: Region | None, surface: SurfaceMesh, movable: NDArray[np.bool_] | None) -> ResolvedRegion:
    """Find out what a region means for a mesh.

    Parameters
    ----------
    region : Region or None
        The limits of a run; None for the default ones.
    surface : SurfaceMesh
        The mesh; not modified.
    movable : ndarray, shape (N,), bool, or None
        Vertices that may move besides.

    Returns
    -------
    ResolvedRegion
        Vertices with weight 0 are not movable. A welded vertex may move as far as the one of its parts that
        may move least.

    Raises
    ------
    RegionError
        In one sentence, if it is no region or does not fit the mesh, if nothing may move, or if nothing is
        left of the welded mesh.
    """
    check_kind("The region", region, Region, "a Region", RegionError)
    region = region or Region()
    if movable is not None:
        movable = as_array("The movable vertices", movable, RegionError)
        _check_movable(movable, surface.n_vertices)
    region.check(surface.n_vertices)
    weights = None
    if region.weights is not None:
        weights = np.asarray(region.weights, np.float64)
        movable = weights > 0.0 if movable is None else movable & (weights > 0.0)
        if (weights == 1.0).all():
            weights = None
    edges = region.feature_edges
    if edges is not None:
        edges = np.asarray(edges)
        edges = edges if len(edges) else None
    weld = None
    if region.weld_distance is not None and (region.weldable is None or region.weldable.any()):
        check_positions(surface)
        weld = make_weld(surface, region.weld_distance, region.weldable)
        # Without a vertex to merge nothing has to be translated; faces may be gone all the same.
        weld = weld if weld.n_merged else None
    worked = surface
    if weld is not None:
        worked = weld.surface
        movable = None if movable is None else weld.least(movable)
        weights = None if weights is None else weld.least(weights)
        edges = None if edges is None else weld.vertex[edges]
    if movable is not None and movable.all():
        movable = None
    if movable is not None and not movable.any():
        raise RegionError(
            "No vertex may move: those that are selected have weight 0, or lie on others that may not move."
        )
    return ResolvedRegion(region, surface, worked, weld, movable, weights, edges)


def _new_numbers(reordering: Reordering) -> NDArray[np.intp]:
    """Return the new number of each vertex."""
    numbers = np.empty(len(reordering.vertex_order), np.intp)
    numbers[reordering.vertex_order] = np.arange(len(numbers))
    return numbers


def _check_movable(movable: NDArray[np.bool_], n_vertices: int) -> None:
    """Raise RegionError unless the mask fits the mesh and selects something."""
    if movable.shape != (n_vertices,) or movable.dtype != bool:
        raise RegionError(
            f"The mask of movable vertices is {movable.dtype} of shape {movable.shape}; "
            f"expected bool ({n_vertices},)."
        )
    if not movable.any():
        raise RegionError("No vertex may move; select at least one.")
