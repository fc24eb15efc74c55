# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bands of a mesh as plain arrays with names: the layout of the files that `framelet bands` writes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...core.settings import DenoiseSettings

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core import SurfaceMesh

LAYOUT = """\
The file has these arrays, for N vertices, E edges and F faces with C corners. Numbers are 32 bits wide;
numpy.load(..., allow_pickle=False) reads them.
- vertices (N, 3): the positions that were analyzed, in object space
- low (N, 3): the low-pass of the coarsest level, a smooth surface
- L1, L2, ... (bands, sites, 3): the high bands of each level, finest first, as vectors in the unit of the
  positions; site k is vertex k; a band that a site does not have is zero
- edges (E, 2), corner_vertex (C,), face_offset (F + 1,): the mesh; the corners of face f are those from
  face_offset[f] up to face_offset[f + 1]
- cell_corners (n, 4), cell_owner (n,), n_quad_cells: with cell-centered frames only, where site k of L1 is
  cell k: first the quads, whose owners are faces, then the pairs of triangles, whose owners are their common
  edges; at coarser levels site k is vertex k
- levels: how many there are
- frame, stencil, boundary, name, version: texts; frame is what auto stood for, name the object's, version
  that of Framelet
"""
"""The layout in words, for the help text."""


def band_arrays(
    surface: SurfaceMesh, settings: DenoiseSettings, max_megabytes: float
) -> dict[str, NDArray[Any]]:
    """Decompose a mesh and name what comes out.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh; not modified.
    settings : DenoiseSettings
        `frame`, `stencil`, `levels` and `boundary` count.
    max_megabytes : float
        Largest size of all arrays together.

    Returns
    -------
    dict of ndarray
        As `LAYOUT` says, without `name` and `version`.

    Raises
    ------
    ValueError
        In one sentence, if the mesh cannot be analyzed, the frame does not fit it, it is too small for so
        many levels, or the bands would be too large.
    """
    import numpy as np

    from ...core.blocks import Blocks
    from ...core.frames import BANKS
    from ...core.mesh.checks import check_surface
    from ...core.mesh.connectivity import connect
    from ...core.stencils.cells import find_cells
    from ...core.transform import make_transform
    from ..mesh_io.mesh_facts import find_facts, is_on_cells, resolve_frame, stored_bytes

    check_surface(surface)
    facts = find_facts(surface)
    frame, stencil, n_levels = resolve_frame(settings.frame, facts), settings.stencil, settings.levels
    megabytes = stored_bytes(frame, stencil, n_levels, facts) / 1e6
    if megabytes > max_megabytes:
        raise ValueError(
            f"The bands take {megabytes:,.0f} MB, more than the {max_megabytes:,g} MB that are allowed; "
            "use fewer levels or another frame, or allow more."
        )
    # In full precision, and rounded once in the end.
    positions = surface.vertices.astype(np.float64)
    with Blocks() as blocks:
        connectivity = connect(surface, blocks)
        transform = make_transform(
            surface.with_vertices(positions),
            frame,
            stencil,
            n_levels,
            boundary=settings.boundary,
            connectivity=connectivity,
            blocks=blocks,
        )
        coefficients = transform.analyze(positions)
    arrays = {
        "vertices": _as_float32(surface.vertices),
        "edges": surface.edges,
        "corner_vertex": surface.corner_vertex,
        "face_offset": surface.face_offset,
        "low": _as_float32(coefficients.low),
    }
    for level in range(n_levels):
        arrays[f"L{level + 1}"] = _as_float32(coefficients.details(level))
    if is_on_cells(frame, stencil):
        cells = find_cells(surface, with_triangles=BANKS[frame].lattice != "QUADS")
        arrays |= {
            "cell_corners": cells.corners,
            "cell_owner": cells.owner,
            "n_quad_cells": np.array(cells.n_quads, np.int32),
        }
    texts = {"frame": transform.frame, "stencil": stencil, "boundary": settings.boundary}
    return (
        arrays
        | {key: np.array(text) for key, text in texts.items()}
        | {"levels": np.array(n_levels, np.int32)}
    )


def _as_float32(values: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return values in the precision of Blender's meshes."""
    import numpy as np

    return np.ascontiguousarray(values, np.float32)
