# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How much memory a run takes, estimated before it begins, and how much there is."""

from __future__ import annotations

import os
import sys
from math import ceil
from pathlib import Path

from .settings import DenoiseSettings

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

MANY_ITEMS = 2**18
"""Vertices or faces from which on it pays to give freed memory back."""

_PER_CELL_TAP = 105
_PER_WALKED_TAP = 20
_PER_BAND = 12  # three coordinates in single precision
_FIXED = 32 * 2**20  # blocks in work

_WIDE_FRAMES = {"BOX_SPLINE_FOUR_DIRECTION": 12} | {f"B_SPLINE_{n}": (n + 1) ** 2 for n in range(1, 7)}
_CELL_FRAMES = ("BOX_SPLINE_FOUR_DIRECTION", "B_SPLINE_1", "B_SPLINE_3", "B_SPLINE_5")


def estimated_bytes(n_vertices: int, n_corners: int, settings: DenoiseSettings) -> int:
    """Estimate the peak of what `denoise` takes besides the mesh itself.

    Parameters
    ----------
    n_vertices, n_corners : int
        Size of the mesh; a triangle has three corners.
    settings : DenoiseSettings
        The run.

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
        return total + 64 * n_vertices * 3 * reach * (reach + 1)
    return total + _frame_bytes(n_vertices, n_corners, settings)


def _frame_bytes(n_vertices: int, n_corners: int, settings: DenoiseSettings) -> int:
    """Return what stencils and coefficients of the frame transform take."""
    frame = settings.frame
    n_neighbors = n_corners / max(n_vertices, 1)
    if settings.stencil == "ADAPTIVE" or frame in ("ADAPTIVE", "PAIRWISE"):
        n_bands = n_neighbors * (n_neighbors + 1) / 2 if frame == "PAIRWISE" else n_neighbors
        per_level = ADAPTIVE_PER_TAP * (n_neighbors + 1) + _PER_BAND * n_bands
        return int(n_vertices * (per_level * settings.levels + ADAPTIVE_ONCE * (settings.levels > 1)))
    n_sites: float = n_vertices
    n_levels = settings.levels
    total = 0.0
    if frame in _WIDE_FRAMES:
        n_taps = _WIDE_FRAMES[frame]
        if frame in _CELL_FRAMES:
            # Cells are pairs of triangles or quads; at coarser levels the sites are the vertices.
            is_triangles = n_neighbors > 5.0
            total += _PER_CELL_TAP * n_taps * (n_corners / 2 if is_triangles else n_corners / 4)
            n_levels -= 1
        total += n_levels * n_sites * n_taps * _PER_WALKED_TAP
        return int(total)
    n_taps = 9 if frame.startswith("LINEAR") else 7
    n_bands = 3 if settings.shrinkage in ("VECTOR", "SCALAR") else n_taps
    per_level = 4 * n_taps + 2 * _PER_BAND * n_bands
    return int(n_sites * (per_level * n_levels + LATTICE_ONCE * (n_levels > 1)))


def available_bytes() -> int | None:
    """Return how much memory is free for new work, in bytes; None if the system does not say."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except (OSError, ValueError, IndexError):
        pass
    if os.name == "nt":
        return _available_on_windows()
    for name in ("SC_AVPHYS_PAGES", "SC_PHYS_PAGES"):  # where free pages are not told, all that there are
        try:
            pages, size = os.sysconf(name), os.sysconf("SC_PAGE_SIZE")
        except (AttributeError, ValueError, OSError):
            continue
        if pages > 0 and size > 0:
            return pages * size
    return None


def _available_on_windows() -> int | None:
    """Ask Windows for the free physical memory."""
    import ctypes

    class Status(ctypes.Structure):
        _fields_ = (
            ("length", ctypes.c_uint32),
            ("load", ctypes.c_uint32),
            *(
                (name, ctypes.c_uint64)
                for name in ("total", "free", "total_page", "free_page", "total_virtual", "free_virtual", "x")
            ),
        )

    status = Status()
    status.length = ctypes.sizeof(Status)
    kernel = getattr(ctypes, "windll", None)
    if kernel is None or not kernel.kernel32.GlobalMemoryStatusEx(ctypes.byref(status)):
        return None
    return int(status.free)


def give_back(n_items: int) -> None:
    """Give freed memory back to the system where its allocator keeps it: glibc, after work on many items.

    It keeps pieces of up to 32 MB, which on large meshes add up to a third of the peak.
    """
    if n_items < MANY_ITEMS or not sys.platform.startswith("linux"):
        return
    import ctypes

    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def check_memory(n_vertices: int, n_corners: int, settings: DenoiseSettings) -> None:
    """Raise ValueError, in one sentence, if a run takes more memory than there is.

    Where the system does not say how much there is, nothing is refused.
    """
    needed, free = estimated_bytes(n_vertices, n_corners, settings), available_bytes()
    if free is not None and needed > free:
        raise ValueError(
            f"{n_vertices:,} vertices need about {_text(needed)} of memory with these settings, but only "
            f"{_text(free)} are free; close other programs, take fewer levels, or split the mesh."
        )


def _text(n_bytes: int) -> str:
    """Return a number of bytes for people."""
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e8 else f"{n_bytes / 1e6:.0f} MB"
