# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What faces a mesh has, found quickly and remembered, so that panels can say which frames fit it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ...core.settings.frame_catalog import FRAME_CATALOG

try:
    from bpy.app.translations import pgettext_n as n_
except ImportError:  # the command line asks without Blender

    def n_(text: str) -> str:
        """Return a text that is shown elsewhere."""
        return text


if TYPE_CHECKING:
    import bpy

    from ...core import SurfaceMesh

_LATTICES = {entry.identifier: entry.lattice for entry in FRAME_CATALOG}
_LABELS = {entry.identifier: entry.label for entry in FRAME_CATALOG}
_HAS_BANK = {entry.identifier: bool(entry.module) for entry in FRAME_CATALOG}
_MOST_MESHES = 64

_facts: dict[tuple[int, ...], MeshFacts] = {}


class MeshFacts(NamedTuple):
    """Counts of a mesh, and what kinds of faces it has; `largest_valence` counts edges at a vertex."""

    n_vertices: int
    n_edges: int
    n_faces: int
    largest_valence: int
    has_triangles: bool
    has_quads: bool
    has_others: bool
    has_triangle_pairs: bool


def find_facts(surface: SurfaceMesh) -> MeshFacts:
    """Look at the faces of a surface."""
    import numpy as np

    sizes = surface.face_sizes()
    corners = np.repeat(sizes, sizes) == 3
    triangles_at_edge = np.bincount(surface.corner_edge[corners], minlength=1)
    valence = np.bincount(surface.edges.ravel(), minlength=1)
    return MeshFacts(
        surface.n_vertices,
        surface.n_edges,
        surface.n_faces,
        int(valence.max()),
        bool((sizes == 3).any()),
        bool((sizes == 4).any()),
        bool(((sizes != 3) & (sizes != 4)).any()),
        bool((triangles_at_edge == 2).any()),
    )


def known_facts(obj: bpy.types.Object | None) -> MeshFacts | None:
    """Return the facts of an object's mesh; they are found once for a mesh and its numbers of elements.

    Returns
    -------
    MeshFacts or None
        None without a mesh with faces, and in Edit Mode, where the mesh is not up to date.
    """
    if obj is None or obj.type != "MESH" or obj.mode == "EDIT" or not len(obj.data.polygons):
        return None
    from . import mesh_bridge

    mesh = obj.data
    counts = (len(mesh.vertices), len(mesh.edges), len(mesh.polygons), len(mesh.loops))
    key = (mesh.as_pointer(), *counts)
    if key not in _facts:
        if len(_facts) >= _MOST_MESHES:
            _facts.clear()
        _facts[key] = find_facts(mesh_bridge.read_surface(obj))
    return _facts[key]


def forget_facts() -> None:
    """Forget all meshes."""
    _facts.clear()


def frame_label(frame: str, stencil: str) -> str:
    """Return the name of a frame for people; the stencil ADAPTIVE takes the masks of that frame for all."""
    if stencil == "ADAPTIVE" and frame != "PAIRWISE":
        frame = "ADAPTIVE"
    return _LABELS.get(frame, frame)


def resolve_frame(frame: str, facts: MeshFacts) -> str:
    """Return the frame that AUTO stands for, as `core.transform.choose_frame` does."""
    if frame != "AUTO" and frame in _LATTICES:
        return frame
    kinds = (facts.has_triangles, facts.has_quads, facts.has_others)
    return {(True, False, False): "BOX_SPLINE_111", (False, True, False): "LINEAR_SPLINE"}.get(
        kinds, "ADAPTIVE"
    )


def is_on_cells(frame: str, stencil: str) -> bool:
    """Tell whether the finest bands of a frame live on cells."""
    if stencil == "ADAPTIVE" or not _HAS_BANK.get(frame):
        return False
    from ...core import BANKS

    return BANKS[frame].is_cell_centered


def misfit(frame: str, stencil: str, facts: MeshFacts) -> tuple[str, str] | None:
    """Say why a frame does not fit a mesh.

    Returns
    -------
    level, reason : str
        ERROR if the frame cannot be used, INFO if it can but is made for other faces; and a short reason.
        None if the frame fits.
    """
    if frame not in _LATTICES or frame == "AUTO" or stencil == "ADAPTIVE":
        return None
    lattice = _LATTICES[frame]
    if lattice == "QUADS" and not facts.has_quads:
        return "ERROR", n_("For quads; this mesh has none")
    if lattice == "TRIANGLES" and not facts.has_triangles:
        return "INFO", n_("For triangles; this mesh has none")
    if is_on_cells(frame, stencil) and not (facts.has_quads or facts.has_triangle_pairs):
        return "ERROR", n_("Needs quads or pairs of triangles")
    return None


def unfit_frames(facts: MeshFacts) -> list[str]:
    """Say which kinds of frames do not fit a mesh, and why, a line each."""
    lines = []
    if not facts.has_quads:
        lines.append(n_("Not for this mesh: frames for quads"))
    if not facts.has_triangles:
        lines.append(n_("Not for this mesh: frames for triangles"))
    return lines


def count_bands(frame: str, stencil: str, facts: MeshFacts) -> int:
    """Return how many high bands a frame, not AUTO, has at most at each level on a mesh."""
    valence = facts.largest_valence
    if frame == "PAIRWISE":
        return valence * (valence + 1) // 2
    if stencil == "ADAPTIVE" or not _HAS_BANK[frame]:
        return valence
    from ...core import BANKS

    return BANKS[frame].n_bands - 1


def stored_bytes(frame: str, stencil: str, levels: int, facts: MeshFacts) -> int:
    """Return how many bytes the bands of a frame, not AUTO, take when they are stored on a mesh."""
    n_bands = count_bands(frame, stencil, facts)
    finest = facts.n_vertices
    if is_on_cells(frame, stencil):
        finest = facts.n_faces * facts.has_quads + facts.n_edges * facts.has_triangle_pairs
    n_vectors = 2 * facts.n_vertices + n_bands * (finest + (levels - 1) * facts.n_vertices)
    return 12 * n_vectors
