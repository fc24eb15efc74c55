# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a run takes, estimated before it begins."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import TooLargeError
from .frames import BANKS, FilterBank
from .frames.valence_masks import FAMILIES
from .mesh.surface_mesh import SurfaceMesh
from .settings import DenoiseSettings
from .value_checks import check_number

BASE_PER_VERTEX = 110
BASE_PER_CORNER = 45
"""Bytes for the neighborhoods and for positions in several forms, which every method needs."""

LEARNED_PER_CORNER = 250
"""Bytes for learned shrinkage: states of faces and pairs, and features; all figures here are measured by
`tests/benchmarks/speed`."""

ADAPTIVE_PER_TAP = 12
ADAPTIVE_ONCE = 100
LATTICE_ONCE = 60
"""Bytes for each tap and level where masks fit the valence; and once, for finding dilated rings."""

USUAL_VALENCE = 16
"""Faces at a vertex up to which neighborhoods are as large as elsewhere."""

PER_NEAR_PAIR, PER_DILATED_PAIR, PER_HUB_BAND, PER_HUB_WALK = 80, 32, 52, 28
"""Bytes for each pair of vertices that see each other across a vertex of high valence: in the neighborhoods
of the bilateral filter, while dilated rings are found, for each band of the frame PAIRWISE, and for each way
out of a cell through such a corner."""

_PER_CELL_TAP = 105
_PER_WALKED_TAP = 20
_PER_BAND = 12  # three coordinates in single precision
_FIXED = 32 * 2**20  # blocks in work


def estimated_bytes(
    n_vertices: int,
    n_corners: int,
    settings: DenoiseSettings,
    high_valences: NDArray[np.integer] | tuple[int, ...] = (),
) -> int:
    """Estimate the peak of what `denoise` takes besides the mesh itself.

    Parameters
    ----------
    n_vertices, n_corners : int
        Size of the mesh; a triangle has three corners.
    settings : DenoiseSettings
        The run.
    high_valences : ndarray, shape (h,), int, optional
        Numbers of faces at vertices that have many, see `high_valences`: around these the number of pairs of
        neighbors grows with the square.

    Returns
    -------
    int
        Bytes; a model with measured constants. On large meshes it is 1.1 to 1.7 times the peak.
    """
    total = _FIXED + BASE_PER_VERTEX * n_vertices + BASE_PER_CORNER * n_corners
    if settings.method == "AUTO":
        return total + LEARNED_PER_CORNER * n_corners
    if settings.method == "BILATERAL":
        reach = max(1, ceil(2.0 * settings.sigma_c))
        # Two numbers for each pair of neighbors, kept once, and held three more times while they are found.
        total += 64 * n_vertices * 3 * reach * (reach + 1)
        return total + PER_NEAR_PAIR * _hub_pairs(n_vertices, high_valences, reach * (reach - 1) / 2)
    return total + _frame_bytes(n_vertices, n_corners, settings, high_valences)


def _hub_pairs(n_vertices: int, valences: NDArray[np.integer] | tuple[int, ...], share: float) -> int:
    """Return how many pairs of vertices see each other across vertices of high valence.

    `share` is how many they are in units of the square of the valence: 1 where two steps are made, less
    than 1 where none are.
    """
    if share < 1.0:
        return 0
    seen = np.minimum(np.asarray(valences, np.float64) * share**0.5, n_vertices)
    return int(np.square(seen).sum())


def _frame_bytes(
    n_vertices: int,
    n_corners: int,
    settings: DenoiseSettings,
    valences: NDArray[np.integer] | tuple[int, ...],
) -> int:
    """Return what stencils and coefficients of the frame transform take."""
    squares = float(np.square(np.asarray(valences, np.float64)).sum())
    of_hubs = 0.0
    if settings.frame == "PAIRWISE":
        of_hubs = PER_HUB_BAND * settings.levels * squares / 2
    n_neighbors = n_corners / max(n_vertices, 1)
    bank = _bank(settings, n_neighbors)
    if bank is not None and _is_walked(bank):
        is_triangles = n_neighbors > 5.0  # with two cells at each corner: on its spoke, and across
        of_hubs += PER_HUB_WALK * _walks_out(bank) * (1 + is_triangles) * squares
    else:
        # The ring of a vertex among quads holds their far corners as well, except with masks of its valence.
        is_wide = bank is not None and bank.lattice == "QUADS"
        share = 4 ** (settings.levels - 1) / 4 * (4 if is_wide and settings.levels > 1 else 1)
        of_hubs += PER_DILATED_PAIR * _hub_pairs(n_vertices, valences, share)
    return int(of_hubs) + _taps_bytes(n_vertices, n_corners, settings)


def _bank(settings: DenoiseSettings, n_neighbors: float) -> FilterBank | None:
    """Return the filter bank of a run; None where the masks fit the valence of each vertex."""
    frame: Any = settings.frame  # a name, or a bank of one's own
    if frame == "AUTO":
        frame = "LINEAR_SPLINE" if n_neighbors <= 5.0 else "BOX_SPLINE_111"
    if settings.stencil == "ADAPTIVE" or frame in FAMILIES:
        return None
    return BANKS[frame] if isinstance(frame, str) else frame


def _is_walked(bank: FilterBank) -> bool:
    """Tell whether stencils are filled by walking on the mesh."""
    return bank.is_cell_centered or bank.reach > 1


def _walks_out(bank: FilterBank) -> int:
    """Return how many walks through each spoke of a cell's corner fill the taps beyond it.

    One leads straight out, two to a tap across the corner, and four to one that lies askew.
    """
    if not bank.is_cell_centered:
        return 0
    a, b = (bank.offsets[(bank.offsets >= 1).all(axis=1)] - 1).T
    is_across = (a > 0) & (b > 0)
    return int(((1 + is_across) * (1 + (is_across & (a != b)))).sum()) - 1


def _taps_bytes(n_vertices: int, n_corners: int, settings: DenoiseSettings) -> int:
    """Return what stencils and coefficients take where no vertex has many neighbors."""
    n_neighbors = n_corners / max(n_vertices, 1)
    bank = _bank(settings, n_neighbors)
    if bank is None:
        n_bands = n_neighbors * (n_neighbors + 1) / 2 if settings.frame == "PAIRWISE" else n_neighbors
        per_level = ADAPTIVE_PER_TAP * (n_neighbors + 1) + _PER_BAND * n_bands
        return int(n_vertices * (per_level * settings.levels + ADAPTIVE_ONCE * (settings.levels > 1)))
    n_levels, n_taps, total = settings.levels, bank.n_taps, 0.0
    if _is_walked(bank):
        if bank.is_cell_centered:
            # Cells are pairs of triangles or quads; at coarser levels the sites are the vertices.
            is_triangles = n_neighbors > 5.0
            total += _PER_CELL_TAP * n_taps * (n_corners / 2 if is_triangles else n_corners / 4)
            n_levels -= 1
        return int(total + n_levels * n_vertices * n_taps * _PER_WALKED_TAP)
    n_bands = 3 if settings.shrinkage in ("VECTOR", "SCALAR") else n_taps
    per_level = 4 * n_taps + 2 * _PER_BAND * n_bands
    return int(n_vertices * (per_level * n_levels + LATTICE_ONCE * (n_levels > 1)))


def check_memory(surface: SurfaceMesh, settings: DenoiseSettings, max_bytes: int | None) -> None:
    """Raise TooLargeError, in one sentence, if a run takes more memory than it may; None for no limit."""
    if max_bytes is None:
        return
    check_number("The memory that a run may take", max_bytes, 0)
    needed = estimated_bytes(surface.n_vertices, surface.n_corners, settings, high_valences(surface))
    if needed > max_bytes:
        raise TooLargeError(
            f"{surface.n_vertices:,} vertices need about {_text(needed)} of memory with these settings, but "
            f"only {_text(max_bytes)} are free; close other programs, take fewer levels, or split the mesh."
        )


def high_valences(surface: SurfaceMesh) -> NDArray[np.intp]:
    """Return the numbers of faces at the vertices that have more than `USUAL_VALENCE`, shape (h,)."""
    counts = np.bincount(surface.corner_vertex)
    return counts[counts > USUAL_VALENCE]


def _text(n_bytes: int) -> str:
    """Return a number of bytes for people."""
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e8 else f"{n_bytes / 1e6:.0f} MB"
