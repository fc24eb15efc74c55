# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the last transforms: to make one takes most of the time of Equalize and Analyze.

A transform is recognized by all that it was made of, value by value.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...core import FrameTransform, SurfaceMesh
    from ...core.blocks import Blocks
    from ...core.equalizer import Equalizer

MOST_BYTES = 1_000_000_000
"""What is kept together; the oldest are dropped first, and what is larger alone is not kept at all."""


class Kept(NamedTuple):
    """What was made, of which mesh, and with which settings."""

    kind: str
    surface: SurfaceMesh
    settings: tuple[Any, ...]
    made: Any


_kept: list[Kept] = []


def equalizer_of(surface: SurfaceMesh, n_levels: int, frame: str, stencil: str, boundary: str) -> Equalizer:
    """Return an equalizer of a mesh, made anew only if it has to be; see `core.equalizer.Equalizer`."""
    from ...core.equalizer import Equalizer

    def make() -> Equalizer:
        return Equalizer(surface, n_levels, frame=frame, stencil=stencil, boundary=boundary)

    return _find("equalizer", surface, (n_levels, frame, stencil, boundary), make)


def transform_of(
    surface: SurfaceMesh, n_levels: int, frame: str, stencil: str, boundary: str
) -> tuple[FrameTransform, Blocks]:
    """Return the transform of a mesh in float64 with all bands, and its threads."""
    import numpy as np

    from ...core.blocks import Blocks
    from ...core.transform import make_transform

    def make() -> tuple[FrameTransform, Blocks]:
        positions = surface.with_vertices(surface.vertices.astype(np.float64))
        with Blocks() as blocks:
            transform = make_transform(positions, frame, stencil, n_levels, boundary=boundary, blocks=blocks)
        return transform, blocks

    return _find("transform", surface, (n_levels, frame, stencil, boundary), make)


def forget_transforms() -> None:
    """Forget all."""
    _kept.clear()


def _find(kind: str, surface: SurfaceMesh, settings: tuple[Any, ...], make: Callable[[], Any]) -> Any:
    """Return what is kept for a mesh and settings; otherwise make it and keep it."""
    from ...core.preparation_cache import bytes_of

    for kept in _kept:
        if (kept.kind, kept.settings) == (kind, settings) and _is_same(kept.surface, surface):
            _kept.remove(kept)
            _kept.append(kept)
            return kept.made
    made = make()
    _kept.append(Kept(kind, surface, settings, made))
    while _kept and sum(bytes_of([kept.made, kept.surface]) for kept in _kept) > MOST_BYTES:
        _kept.pop(0)
    return made


def _is_same(first: SurfaceMesh, second: SurfaceMesh) -> bool:
    """Tell whether two meshes have the same arrays."""
    import numpy as np

    return all(
        np.array_equal(getattr(first, item.name), getattr(second, item.name)) for item in fields(first)
    )
