# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what was prepared for the last meshes, so that a run with another λ does not prepare them again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from .errors import FrameletError
from .limits.resolved_region import ResolvedRegion
from .mesh.connectivity import Connectivity
from .mesh.surface_mesh import SurfaceMesh
from .precision import as_precision
from .prepared import Prepared, check_given, prepare, prepare_again
from .settings import DenoiseSettings
from .value_checks import check_kind, check_number

MAX_BYTES = 2**30
"""By default this much is kept: what four meshes of half a million vertices need."""


class PreparationCache:
    """The last prepared meshes; a mesh is recognized by the values of all its arrays.

    Not for use by several threads at once.

    Parameters
    ----------
    max_bytes : int
        How much may be kept. The meshes that were used longest ago are dropped first; what is larger alone is
        not kept at all.
    """

    def __init__(self, max_bytes: int = MAX_BYTES) -> None:
        check_number("The number of bytes that are kept", max_bytes, 0)
        self.max_bytes = max_bytes
        self._kept: list[Prepared] = []  # the last used one is last

    def __len__(self) -> int:
        return len(self._kept)

    def prepare(
        self,
        surface: SurfaceMesh,
        settings: DenoiseSettings,
        dtype: DTypeLike = np.float32,
        should_stop: Callable[[], bool] | None = None,
    ) -> Prepared:
        """Return what `core.prepared.prepare` returns, made anew only as far as it has to be.

        The mesh may be edited in place afterwards: arrays that can be written to are copied. Raises
        `Stopped` if it was asked to stop.
        """
        check_given(surface, settings, None, should_stop)
        dtype = as_precision(dtype)
        previous = next((kept for kept in reversed(self._kept) if kept.has_topology_of(surface)), None)
        prepared = prepare_again(surface, settings, previous, dtype=dtype, should_stop=should_stop)
        # One for each topology: the old one would only serve if its positions came back.
        self._kept = [kept for kept in self._kept if kept is not previous]
        self._kept.append(prepared)
        while self._kept and sum(map(bytes_of, self._kept)) > self.max_bytes:
            self._kept.pop(0)
        return prepared

    def forget(self) -> None:
        """Drop everything."""
        self._kept.clear()


def prepared_for(
    resolved: ResolvedRegion,
    settings: DenoiseSettings,
    connectivity: Connectivity | None,
    dtype: DTypeLike,
    should_stop: Callable[[], bool] | None,
    known: Prepared | PreparationCache | None,
) -> Prepared:
    """Return what is prepared of the mesh that a region is for: made anew, or what is known of it.

    `known` is what was prepared before, or what keeps it. Of a welded mesh the neighborhoods are not those
    that were given.

    Raises
    ------
    FrameletError
        If what was prepared is for another mesh or other stencils, or something else.
    """
    check_kind("What is prepared", known, (Prepared, PreparationCache), "what `prepare` returns or a cache")
    surface, dtype = resolved.surface, as_precision(dtype)
    if resolved.weld is not None:
        connectivity = None
    if isinstance(known, PreparationCache):
        return known.prepare(surface, settings, dtype, should_stop)
    if known is None:
        return prepare(
            surface, settings, connectivity=connectivity, dtype=dtype, should_stop=should_stop, is_kept=False
        )
    if not known.fits(surface, settings, dtype):
        raise FrameletError("This was prepared for another mesh or other stencils; prepare it again.")
    return known


def bytes_of(owner: Any) -> int:
    """Return how many bytes the arrays take that belong to an object and to the objects it holds."""
    sizes: dict[int, int] = {}
    _measure(owner, sizes, set())
    return sum(sizes.values())


def _measure(item: Any, sizes: dict[int, int], seen: set[int]) -> None:
    """Add the sizes of the arrays below an item, each memory once."""
    if id(item) in seen:
        return
    seen.add(id(item))
    if isinstance(item, np.ndarray):
        while isinstance(item.base, np.ndarray):
            item = item.base
        sizes[id(item)] = item.nbytes
    elif isinstance(item, (list, tuple)):
        for part in item:
            _measure(part, sizes, seen)
    elif type(item).__module__.startswith(__name__.rpartition(".")[0]):
        for part in vars(item).values() if hasattr(item, "__dict__") else ():
            _measure(part, sizes, seen)
