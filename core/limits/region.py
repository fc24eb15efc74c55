# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where vertices may move, how far, and what is mended afterwards."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import RegionError
from ..precision import as_array


@dataclass(frozen=True, eq=False)
class Region:
    """Limits of a denoising run, for all methods.

    Attributes
    ----------
    weights : array_like, shape (N,), or None
        Share of its motion that each vertex makes, from 0 to 1. Vertices with weight 0 are used but stay
        where they are, bit for bit; None for 1 everywhere.
    feature_edges : array_like of int, shape (E, 2), or None
        Edges, as pairs of vertices, that form feature lines: their vertices are smoothed along the line only,
        see `lines.py`. Edges of a vertex with itself are left out.
    max_displacement : float or None
        Farthest that a vertex may move, in the unit of the mesh; None for no limit.
    along_normals : bool
        Whether vertices move along the normals of the denoised surface only.
    keep_volume : bool
        Whether a closed mesh keeps its volume; an open mesh has none to keep.
    weld_distance : float or None
        Vertices at most so far apart, in the unit of the mesh, are one vertex for the work, and move
        together; 0 for those at the same place, None for no welding.
    weldable : ndarray, shape (N,), bool, or None
        Vertices that may be welded, as those of borders; None for all.
    repair_folds : bool
        Whether motions that fold faces are taken back.
    straighten_borders : bool
        Whether frayed and zigzag borders become smooth, see `straight_borders.py`.
    flatten_spikes : bool
        Whether single vertices and small clusters far off their surroundings, see `mesh.spikes`, come down to
        them first. Learned shrinkage brings them down by itself; the other methods take them for shape.

    Raises
    ------
    RegionError
        On construction, in one sentence, if a value is out of range.
    """

    weights: NDArray[np.floating] | None = None
    feature_edges: NDArray[np.integer] | None = None
    max_displacement: float | None = None
    along_normals: bool = False
    keep_volume: bool = False
    weld_distance: float | None = None
    weldable: NDArray[np.bool_] | None = None
    repair_folds: bool = True
    straighten_borders: bool = False
    flatten_spikes: bool = False

    def __post_init__(self) -> None:
        if self.weights is not None:
            weights = as_array("The weights", self.weights, RegionError)
            if weights.dtype.kind in "biu":
                weights = weights.astype(np.float64)
            object.__setattr__(self, "weights", weights)
            _check_weights(weights)
        if self.feature_edges is not None:
            edges = as_array("The feature edges", self.feature_edges, RegionError)
            object.__setattr__(self, "feature_edges", edges)
            if edges.ndim != 2 or edges.shape[1] != 2 or not np.issubdtype(edges.dtype, np.integer):
                raise RegionError(
                    f"The feature edges are {edges.dtype} of shape {edges.shape}; expected whole numbers of "
                    "shape (E, 2), two vertices for each edge."
                )
        if self.weldable is not None:
            mask = as_array("The weldable vertices", self.weldable, RegionError)
            object.__setattr__(self, "weldable", mask)
            if mask.ndim != 1 or mask.dtype != bool:
                raise RegionError(
                    f"The mask of weldable vertices is {mask.dtype} of shape {mask.shape}; expected one "
                    "truth value a vertex."
                )
        for item in fields(self):
            if item.type == "bool":
                _check_switch(item.name.replace("_", " "), getattr(self, item.name))
        _check_length("largest displacement", self.max_displacement)
        _check_length("weld distance", self.weld_distance)

    def check(self, n_vertices: int) -> None:
        """Raise RegionError, in one sentence, unless this fits a mesh with so many vertices."""
        if self.weights is not None:
            if len(self.weights) != n_vertices:
                raise RegionError(
                    f"There are {len(self.weights)} weights for {n_vertices} vertices; give one for each."
                )
            if not np.any(self.weights):
                raise RegionError("All weights are 0, so that no vertex may move; give some a larger weight.")
        if self.weldable is not None and len(self.weldable) != n_vertices:
            raise RegionError(
                f"The mask of weldable vertices has {len(self.weldable)} entries for {n_vertices} vertices; "
                "give one for each."
            )
        edges = self.feature_edges
        if edges is not None and np.size(edges) and (np.min(edges) < 0 or np.max(edges) >= n_vertices):
            wrong = int(np.min(edges)) if np.min(edges) < 0 else int(np.max(edges))
            raise RegionError(
                f"A feature edge names vertex {wrong}, but there are {n_vertices} vertices; take it out."
            )


def _check_weights(weights: NDArray[Any]) -> None:
    """Raise RegionError unless these are numbers from 0 to 1, one for each vertex."""
    if weights.ndim != 1 or not np.issubdtype(weights.dtype, np.floating):
        raise RegionError(
            f"The weights are {weights.dtype} of shape {weights.shape}; expected one real number a vertex."
        )
    is_wrong = ~((weights >= 0.0) & (weights <= 1.0))  # also refuses NaN
    if is_wrong.any():
        vertex = int(np.flatnonzero(is_wrong)[0])
        raise RegionError(
            f"The weight of vertex {vertex} is {weights[vertex]:g}; weights must be between 0 and 1."
        )


def _check_switch(name: str, value: Any) -> None:
    """Raise RegionError unless this is a truth value."""
    if not isinstance(value, bool | np.bool_):
        raise RegionError(f"The choice {name!r} is {value!r}; it must be True or False.")


def _check_length(name: str, value: Any) -> None:
    """Raise RegionError unless this is None or a length that is not negative."""
    if value is None:
        return
    if not isinstance(value, int | float | np.integer | np.floating) or isinstance(value, bool):
        raise RegionError(f"The {name} is {value!r}; it must be a number.")
    if not 0.0 <= value < float("inf"):
        raise RegionError(f"The {name} is {value:g}; it must be 0 or a positive number.")
