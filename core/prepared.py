# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run needs and later runs on the same mesh can use again: neighborhoods, stencils, normalized space.

It depends on the mesh and on the settings that choose the stencils, not on λ, μ, δ, iterations and the like.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .blocks import BLOCK_SIZE, Blocks
from .learned.engine import FaceEngine
from .limits.constraints import Constraints, Corners, find_constraints, find_corners
from .limits.face_flips import FaceState
from .limits.lines import find_lines, smoothing_of
from .limits.resolved_region import ResolvedRegion
from .limits.straight_borders import find_curves, straightened
from .mesh.checks import check_mesh, check_positions, check_surface
from .mesh.connectivity import Connectivity, check_connectivity, connect_agreeing
from .mesh.geometry import coordinate_rows
from .mesh.locality import Reordering, is_scattered, reorder, same_order, spatial_order
from .mesh.normalization import normalize
from .mesh.spikes import without_spikes
from .mesh.surface_mesh import SurfaceMesh
from .methods.problem import Callback, Problem
from .methods.proximal import SEPARABLE
from .precision import as_precision
from .settings import DEFAULT_PRESET, PRESETS, DenoiseSettings
from .transform import FrameTransform, choose_frame, make_transform
from .value_checks import check_callable, check_kind, check_number

TOPOLOGY = tuple(item.name for item in fields(SurfaceMesh) if item.name != "vertices")


@dataclass(eq=False)
class Prepared:
    """A mesh that is ready to be denoised.

    It holds arrays that a run writes to: use it for one run at a time.

    Attributes
    ----------
    surface : SurfaceMesh
        The mesh that it was made for; nobody can write to its arrays.
    reordering : Reordering or None
        The same mesh with other numbers, if that makes the work faster, and with faces that agree about
        their orientation, if they did not; the arrays below go by it.
    connectivity : Connectivity
        The neighborhoods.
    edge : float
        Mean edge length in scene units.
    noisy : ndarray, shape (3, N)
        Normalized positions.
    corners : Corners
        Corners of borders.
    transform : FrameTransform or None
        The frame, if the method uses one.
    engine : FaceEngine or None
        Tables of faces, if the method uses them.
    blocks : Blocks
        Threads to work on, to be entered by each run.
    faces : FaceState or None
        What the first run that was finished on it found out about the faces of `ordered`; None before.
    """

    surface: SurfaceMesh
    reordering: Reordering | None
    connectivity: Connectivity
    edge: float
    noisy: NDArray[np.floating]
    corners: Corners
    transform: FrameTransform | None
    engine: FaceEngine | None
    blocks: Blocks
    key: tuple[Any, ...]
    faces: FaceState | None = None

    @property
    def ordered(self) -> SurfaceMesh:
        """The mesh in the numbering that the work is done in."""
        return self.surface if self.reordering is None else self.reordering.surface

    def fits(self, surface: SurfaceMesh, settings: DenoiseSettings, dtype: DTypeLike = np.float32) -> bool:
        """Tell whether this can be used for a mesh and settings: all arrays are compared value by value."""
        return self.has_topology_of(surface) and self.fits_positions(surface, settings, dtype)

    def has_topology_of(self, surface: SurfaceMesh) -> bool:
        """Tell whether this was made for a mesh with the same faces and edges."""
        return all(_is_same(getattr(self.surface, name), getattr(surface, name)) for name in TOPOLOGY)

    def fits_positions(
        self, surface: SurfaceMesh, settings: DenoiseSettings, dtype: DTypeLike = np.float32
    ) -> bool:
        """Tell whether this can be used for a mesh whose faces and edges are known to be the same."""
        return self.key == _key(settings, dtype) and _is_same(self.surface.vertices, surface.vertices)

    def problem(
        self, resolved: ResolvedRegion, settings: DenoiseSettings, blocks: Blocks, callback: Callback | None
    ) -> Problem:
        """Return what a method is given; the region goes by the numbers of `ordered`."""
        constraints = find_constraints(
            self.ordered, self.connectivity, settings, resolved.movable, self.noisy.dtype, self.corners
        )
        given, surface, engine = self.noisy, self.ordered, self.engine
        if resolved.region.flatten_spikes:
            surface = without_spikes(surface, constraints.pinned)
            motion = (surface.vertices.astype(np.float64) - self.ordered.vertices).T / self.edge
            given = given + motion.astype(given.dtype)
            engine = None if engine is None else engine.for_positions(surface, self.connectivity)
        if resolved.region.straighten_borders:
            given, constraints = self._with_straight_borders(given, constraints)
        problem = Problem(
            noisy=given,
            given=given,
            surface=surface,
            connectivity=self.connectivity,
            edge=self.edge,
            settings=settings,
            constraints=constraints,
            blocks=blocks,
            transform=self.transform,
            engine=engine,
            callback=callback,
            movable=resolved.movable,
        )
        if resolved.feature_edges is None:
            return problem
        lines = find_lines(given, resolved.feature_edges, constraints.pinned)
        noisy = given.copy()
        noisy[:, lines.inner] += smoothing_of(given, lines, _line_strength(settings)).astype(noisy.dtype)
        return replace(
            problem,
            noisy=noisy,
            constraints=constraints.with_pinned(lines.vertices),
            line_vertices=len(lines.vertices),
        )

    def _with_straight_borders(
        self, given: NDArray[np.floating], constraints: Constraints
    ) -> tuple[NDArray[np.floating], Constraints]:
        """Return the positions with smooth borders, and constraints that keep what was moved there."""
        curves = find_curves(self.connectivity.boundary_neighbors)
        stays = np.zeros(self.noisy.shape[1], bool)
        stays[constraints.pinned] = True
        motion = straightened(given, curves, stays).astype(given.dtype)
        points = given.copy()
        points[:, curves.vertices] += motion
        return points, constraints.with_pinned(curves.vertices[motion.any(axis=0)])

    def motion(self, points: NDArray[np.floating], blocks: Blocks) -> NDArray[np.float64]:
        """Return the displacements, shape (3, N), in scene units, to points of normalized space."""
        motion = np.empty(points.shape)

        def kernel(start: int, stop: int) -> None:
            part = motion[:, start:stop]
            part[:] = points[:, start:stop]
            part -= self.noisy[:, start:stop]
            part *= self.edge

        blocks.run(kernel, points.shape[1])
        return motion

    def known_faces(self, resolved: ResolvedRegion) -> FaceState | None:
        """Return what is known of the faces of the input; nothing of those that move with a welded mesh."""
        return self.faces if resolved.weld is None else None

    def remember(self, resolved: ResolvedRegion, faces: FaceState) -> None:
        """Keep what a run found out about the faces of the input."""
        if resolved.weld is None:
            self.faces = faces


def check_given(
    surface: SurfaceMesh,
    settings: DenoiseSettings | None,
    connectivity: Connectivity | None,
    should_stop: Callable[[], bool] | None,
    callback: Callback | None = None,
) -> None:
    """Raise a FrameletError if one of these is of another type, or if they do not fit each other."""
    check_mesh(surface)
    check_kind("The settings", settings, DenoiseSettings, "DenoiseSettings")
    check_connectivity(connectivity, surface)
    check_callable("What stops the run", should_stop)
    check_callable("The callback", callback)


def prepare(
    surface: SurfaceMesh,
    settings: DenoiseSettings | None = None,
    *,
    connectivity: Connectivity | None = None,
    dtype: DTypeLike = np.float32,
    previous: Prepared | None = None,
    should_stop: Callable[[], bool] | None = None,
    block_size: int = BLOCK_SIZE,
    is_kept: bool = True,
) -> Prepared:
    """Do all of a run that does not depend on λ, μ, δ, iterations, tolerance and movable vertices.

    Parameters
    ----------
    surface : SurfaceMesh
        The noisy surface, to scripts also `vertices, faces`; not modified. It is kept, as a copy where its
        arrays can be written to.
    settings : DenoiseSettings, optional
        Method, frame, stencil, levels, boundary and shrinkage count; by default those of the preset AUTO.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already.
    dtype : dtype, optional
        Precision of the solver.
    previous : Prepared, optional
        What was prepared before. If it is for the same mesh and the same stencils it is returned; if only the
        faces are the same, its neighborhoods are used.
    should_stop : callable, optional
        Asked many times; returns True to stop.
    block_size : int, optional
        Vertices in a block of work for a thread.
    is_kept : bool
        Whether the result is kept. If it serves one run only, during which nobody writes to the mesh, the
        mesh is not copied.

    Raises
    ------
    Stopped
        If it was asked to stop.
    ValueError
        In one sentence, if the mesh has no faces, no size or positions that are not finite, if the frame
        does not fit it, or if an argument is of another type.
    """
    check_given(surface, settings, connectivity, should_stop)
    check_kind("What was prepared before", previous, Prepared, "what `prepare` returned")
    check_number("The size of a block", block_size, 1, is_whole=True)
    dtype = as_precision(dtype)
    settings = settings or PRESETS[DEFAULT_PRESET].settings
    if previous is not None and not previous.has_topology_of(surface):
        previous = None
    return prepare_again(
        surface, settings, previous, connectivity, dtype, should_stop, is_kept=is_kept, block_size=block_size
    )


def prepare_again(
    surface: SurfaceMesh,
    settings: DenoiseSettings,
    previous: Prepared | None,
    connectivity: Connectivity | None = None,
    dtype: DTypeLike = np.float32,
    should_stop: Callable[[], bool] | None = None,
    *,
    is_kept: bool = True,
    block_size: int = BLOCK_SIZE,
) -> Prepared:
    """Do what `prepare` does, with something `previous` that is known to have the topology of the mesh."""
    if previous is not None and previous.fits_positions(surface, settings, dtype):
        return previous
    if is_kept:
        # Of a mesh that is known only the positions are new.
        known = surface if previous is None else previous.surface
        surface = known.with_vertices(surface.vertices).frozen()
    reordering = None
    if previous is not None:
        connectivity, reordering = previous.connectivity, previous.reordering
        if reordering is not None:
            reordering = reordering.with_vertices(surface.vertices)
    blocks = Blocks(settings.threads, block_size)
    with blocks.entered(should_stop):
        check_positions(surface)  # while its vertices have the numbers that the caller knows
        if connectivity is None and is_scattered(surface):
            reordering = reorder(surface, spatial_order(surface.vertices), blocks)
        labels = None if reordering is None else reordering.vertex_order
        ordered = surface if reordering is None else reordering.surface
        if connectivity is None or (previous is None and not connectivity.is_oriented):
            agreeing, connectivity, is_reversed = connect_agreeing(ordered, blocks, labels)
            if is_reversed is not None:
                reordering = reordering or same_order(surface)
                reordering = replace(reordering, surface=agreeing, is_reversed=is_reversed)
                ordered = agreeing
        edge = check_surface(ordered, blocks, connectivity.edge_face_count)
        normalized = normalize(ordered, connectivity, edge, blocks)
        transform = engine = None
        if settings.method == "AUTO":
            engine = None if previous is None else previous.engine
            if engine is None:
                engine = FaceEngine(ordered, connectivity, blocks)
            engine = engine.for_positions(ordered, connectivity)
        if settings.method == "POSITIONS":
            # Chosen on the normalized surface in full precision, so that rounding decides nothing.
            transform = make_transform(
                ordered.with_vertices(normalized),
                choose_frame(settings.frame, connectivity),
                settings.stencil,
                settings.levels,
                boundary=settings.boundary,
                connectivity=connectivity,
                blocks=blocks,
                dtype=dtype,
                only_used_bands=settings.shrinkage in SEPARABLE,
            )
        # The fit of learned shrinkage pulls nothing along borders, so that their corners need no care.
        boundary = "FREE" if settings.method == "AUTO" else settings.boundary
        corners = find_corners(ordered, connectivity, boundary)
        noisy = coordinate_rows(normalized, blocks, dtype)
    return Prepared(
        surface,
        reordering,
        connectivity,
        edge,
        noisy,
        corners,
        transform,
        engine,
        blocks,
        _key(settings, dtype),
    )


def _key(settings: DenoiseSettings, dtype: DTypeLike) -> tuple[Any, ...]:
    """Return what makes the stencils, besides the mesh."""
    frame: tuple[Any, ...] = ()
    if settings.method == "POSITIONS":
        frame = (settings.frame, settings.stencil, settings.levels, settings.shrinkage in SEPARABLE)
    return (settings.method, settings.boundary, np.dtype(dtype), *frame)


def _is_same(first: NDArray[Any], second: NDArray[Any]) -> bool:
    """Tell whether two arrays have the same type, shape and values."""
    return first is second or (first.dtype == second.dtype and np.array_equal(first, second))


def _line_strength(settings: DenoiseSettings) -> float:
    """Return how much of the noise on feature lines is removed: nothing where nothing else is."""
    if settings.method == "POSITIONS" and settings.tuning == "GIVEN" and settings.lambda_ == 0.0:
        return 0.0
    return settings.strength
