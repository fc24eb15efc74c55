# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Store the bands of an object's mesh, and rebuild the mesh from them. No user interface."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io import band_storage, mesh_bridge
from ..mesh_io.band_storage import LOW, REST, BandNote, band_name
from ..mesh_io.mesh_facts import find_facts, is_on_cells, resolve_frame, stored_bytes
from ..mesh_io.own_names import kind_refusal
from ..modifier import offsets
from ..run.shape import check_cage
from .transforms import transform_of

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core import FrameCoefficients, SurfaceMesh
    from ...core.stencils.cells import Cells


class Place(NamedTuple):
    """Where some sites of a level are stored: site `sites[i]` at element `elements[i]` of a domain."""

    domain: str
    n_elements: int
    sites: slice
    elements: NDArray[np.integer] | slice
    has_suffix: bool


class StoredBands(NamedTuple):
    """Bands that were read from a mesh.

    Attributes
    ----------
    note : BandNote
        How they were made.
    surface : SurfaceMesh
        The mesh with its present positions.
    rest : ndarray, shape (N, 3), float32
        The positions that were analyzed.
    low : ndarray, shape (N, 3), float32
        The low-pass.
    details : list of ndarray, shape (H, n_sites, 3), float32
        The high bands of each level, finest first.
    """

    note: BandNote
    surface: SurfaceMesh
    rest: NDArray[np.float32]
    low: NDArray[np.float32]
    details: list[NDArray[np.float32]]


def megabytes_text(n_bytes: int) -> str:
    """Return a size in words."""
    if n_bytes < 1e6:
        return f"{n_bytes / 1e3:.0f} kB"
    return f"{n_bytes / 1e6:,.0f} MB" if n_bytes >= 1e7 else f"{n_bytes / 1e6:.1f} MB"


def analyze_object(
    obj: bpy.types.Object,
    frame: str = "AUTO",
    stencil: str = "STRAIGHT",
    levels: int = 1,
    boundary: str = "ALONG",
    max_megabytes: float = 500.0,
) -> tuple[BandNote, int]:
    """Store the bands of an object's mesh as attributes; bands that it had are replaced.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode. The positions of its active shape key are analyzed, modifiers are not
        applied.
    frame, stencil, levels, boundary
        See `DenoiseSettings`.
    max_megabytes : float
        Store nothing if it would take more.

    Returns
    -------
    note : BandNote
        What was stored.
    n_bytes : int
        The size of all attributes together.

    Raises
    ------
    ValueError
        With a sentence that names the object. The mesh is as it was.
    """
    check_cage(obj, "bands that are kept", "press Equalize, or ")
    reason = kind_refusal(obj, band_storage.BANDS)
    if reason is not None:
        raise ValueError(reason)
    import numpy as np

    from ...core.mesh.checks import check_surface

    surface = mesh_bridge.read_surface(obj)
    with _naming(obj):
        check_surface(surface)
        facts = find_facts(surface)
        frame = resolve_frame(frame, facts)
        n_bytes = stored_bytes(frame, stencil, levels, facts)
        if not n_bytes <= max_megabytes * 1e6:  # also refuses NaN
            raise ValueError(
                f"The bands take {megabytes_text(n_bytes)}, more than the {max_megabytes:,g} MB that are "
                "allowed; use fewer levels or another frame, or allow more."
            )
        coefficients = _analyze(surface, frame, stencil, levels, boundary)
    details = [coefficients.details(level) for level in range(levels)]
    note = BandNote(
        frame,
        stencil,
        levels,
        boundary,
        tuple(len(bands) for bands in details),
        band_storage.topology_fingerprint(surface),
        band_storage.position_fingerprint(surface.vertices),
    )
    stored = [(REST, "POINT", surface.vertices), (LOW, "POINT", coefficients.low)]
    for level, bands in enumerate(details):
        for place in _places(surface, note, level):
            for band, vectors in enumerate(bands, 1):
                values = np.zeros((place.n_elements, 3), np.float32)
                values[place.elements] = vectors[place.sites]
                stored.append((band_name(level + 1, band, place.has_suffix), place.domain, values))
    # Nothing is changed before everything is there.
    mesh = obj.data
    band_storage.remove_bands(mesh)
    band_storage.write_note(mesh, note)
    for name, domain, values in stored:
        band_storage.write_vectors(mesh, name, domain, values)
    mesh.update()
    return note, sum(12 * len(values) for _, _, values in stored)


def read_bands(obj: bpy.types.Object) -> StoredBands:
    """Read the bands of an object's mesh.

    Raises
    ------
    ValueError
        With a sentence that names the object, if there are none, or they do not belong to the mesh any more.
    """
    import numpy as np

    reason = mesh_bridge.refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    note = band_storage.read_note(obj)
    surface = mesh_bridge.read_surface(obj)
    if band_storage.topology_fingerprint(surface) != note.topology:
        raise ValueError(f"‘{obj.name}’ has other faces than when its bands were stored; analyze it again.")
    rest = band_storage.read_vectors(obj, REST, "POINT")
    if band_storage.position_fingerprint(rest) != note.rest:
        raise ValueError(
            f"The attribute {REST} of ‘{obj.name}’, the analyzed positions, was altered; analyze it again."
        )
    low = band_storage.read_vectors(obj, LOW, "POINT")
    details = []
    for level, n_bands in enumerate(note.n_bands):
        places = _places(surface, note, level)
        n_sites = max(place.sites.stop for place in places)
        bands = []
        for band in range(1, n_bands + 1):
            vectors = np.empty((n_sites, 3), np.float32)
            for place in places:
                name = band_name(level + 1, band, place.has_suffix)
                values = band_storage.read_vectors(obj, name, place.domain)
                vectors[place.sites] = values[place.elements]
            bands.append(vectors)
        details.append(np.stack(bands))
    return StoredBands(note, surface, rest, low, details)


def synthesize_object(obj: bpy.types.Object) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Move the vertices of an object's mesh to where its stored bands say.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode; its active shape key is edited.

    Returns
    -------
    before, after : ndarray, shape (N, 3), float32
        Positions in object space.

    Raises
    ------
    ValueError
        With a sentence that names the object, if bands are missing, altered or outdated. The mesh is as it
        was.

    Notes
    -----
    The synthesis V is linear, and V W S = S. So V b = S + V (b - W S), with the analyzed positions S: bands
    that nobody edited give back the same bits, whatever their rounding when they were stored.
    """
    stored = read_bands(obj)
    import numpy as np

    note = stored.note
    with _naming(obj):
        rest = stored.surface.with_vertices(stored.rest)
        coefficients = _analyze(rest, note.frame, note.stencil, note.levels, note.boundary)
        details = [coefficients.details(level) for level in range(note.levels)]
        if [bands.shape for bands in details] != [bands.shape for bands in stored.details]:
            raise ValueError("The stored bands are not those of their frame; analyze it again.")
    edits = [
        new.astype(np.float64) - old.astype(np.float32)
        for new, old in zip(stored.details, details, strict=True)
    ]
    low = stored.low.astype(np.float64) - coefficients.low.astype(np.float32)
    change = coefficients.transform.synthesize(coefficients.with_details(edits, low))
    with np.errstate(over="ignore"):
        vertices = (stored.rest + change).astype(np.float32)
    if not np.isfinite(vertices).all():
        raise ValueError(f"The bands of ‘{obj.name}’ are too large to give positions; analyze it again.")
    mesh_bridge.write_vertices(obj, stored.surface, vertices)
    return stored.surface.vertices, vertices


def clear_object(obj: bpy.types.Object) -> None:
    """Remove everything that Framelet stored on an object's mesh.

    Raises
    ------
    ValueError
        With a sentence that names the object, if its mesh cannot be written to.
    """
    reason = mesh_bridge.ownership_refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    band_storage.remove_bands(obj.data)
    band_storage.remove_colors(obj.data)
    band_storage.remove_noise(obj.data)
    offsets.remove_all(obj)


def find_note_cells(surface: SurfaceMesh, note: BandNote) -> Cells:
    """Return the cells on which the finest bands of a cell-centered frame live."""
    from ...core import BANKS
    from ...core.stencils.cells import find_cells

    with_triangles = BANKS[note.frame].lattice != "QUADS"
    return find_cells(surface, with_triangles=with_triangles)


def _analyze(surface: SurfaceMesh, frame: str, stencil: str, levels: int, boundary: str) -> FrameCoefficients:
    """Return the coefficients of a surface in float64; the same surface gives the same."""
    import numpy as np

    transform, blocks = transform_of(surface, levels, frame, stencil, boundary)
    with blocks:
        return transform.analyze(surface.vertices.astype(np.float64))


def _places(surface: SurfaceMesh, note: BandNote, level: int) -> list[Place]:
    """Return where the sites of a level are stored."""
    if level > 0 or not is_on_cells(note.frame, note.stencil):
        return [Place("POINT", surface.n_vertices, slice(0, surface.n_vertices), slice(None), False)]
    cells = find_note_cells(surface, note)
    n_quads, n_cells = cells.n_quads, len(cells.owner)
    places = []
    if n_quads:
        places.append(Place("FACE", surface.n_faces, slice(0, n_quads), cells.owner[:n_quads], False))
    if n_cells > n_quads:
        has_both = n_quads > 0
        edges = cells.owner[n_quads:]
        places.append(Place("EDGE", surface.n_edges, slice(n_quads, n_cells), edges, has_both))
    return places


@contextmanager
def _naming(obj: bpy.types.Object) -> Iterator[None]:
    """Put the name of an object before the sentence of a ValueError."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"‘{obj.name}’: {error}") from error
