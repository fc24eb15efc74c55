# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One number for each vertex from the stored bands of an object, and the range that colors cover."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io.band_storage import COLORS
from ..mesh_io.mesh_facts import is_on_cells
from ..mesh_io.own_names import kind_refusal
from ..properties.scene_units import linear_part, surface_in_scene, turning
from .bands import StoredBands, find_note_cells, read_bands

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray


class BandChoice(NamedTuple):
    """What to look at.

    `content` is BAND, LEVEL (the norm over all bands of a level) or LOW (the low-pass); `level` and `band`
    count from 1; `component` is NORMAL or LENGTH, which a norm is in any case.
    """

    content: str = "BAND"
    level: int = 1
    band: int = 1
    component: str = "NORMAL"

    @property
    def is_signed(self) -> bool:
        """Whether values have a sign."""
        return self.component == "NORMAL" and self.content != "LEVEL"

    @property
    def title(self) -> str:
        """The choice in words."""
        if self.content == "LOW":
            return "Low-pass"
        return f"Level {self.level}" + (f", band {self.band}" if self.content == "BAND" else "")


class BandValues(NamedTuple):
    """Values of a choice at the vertices of an object, shape (N,), in scene units."""

    obj: bpy.types.Object
    values: NDArray[np.float64]


class ColorRange(NamedTuple):
    """The values that colors cover: from -limit, or 0 without a sign, to limit, in scene units.

    `largest` is the largest magnitude of all values, and `share`, 0 to 1, says how many are within. Values up
    to `tolerance` are green, if it is not 0, and `green` says how many are.
    """

    limit: float
    largest: float
    share: float
    tolerance: float = 0.0
    green: float = 0.0


def choose_values(obj: bpy.types.Object, choice: BandChoice) -> BandValues:
    """Return the chosen numbers at the vertices of an object, with its scale.

    Signed numbers are components along the vertex normals of the analyzed surface. Numbers on cells are
    averaged over the cells of a vertex; vertices without a cell have 0. Of the low-pass it is the way from
    the analyzed position to the low-pass.

    Raises
    ------
    ValueError
        With a sentence that names the object, if its bands cannot be read or there is no such band.
    """
    stored = read_bands(obj)
    reason = kind_refusal(obj, COLORS)
    if reason is not None:
        raise ValueError(reason)
    _check(obj, stored, choice)
    import numpy as np

    part = linear_part(obj)
    if choice.content == "LOW":
        chosen: NDArray[np.floating] = stored.low.astype(np.float64)[None] - stored.rest
    else:
        chosen = stored.details[choice.level - 1]
        if choice.content == "BAND":
            chosen = chosen[choice.band - 1 : choice.band]
    is_cells = (
        choice.content != "LOW" and choice.level == 1 and is_on_cells(stored.note.frame, stored.note.stencil)
    )
    if choice.is_signed:
        vectors = chosen[0].astype(np.float64) @ part.T
        if is_cells:
            vectors = _mean_over_cells(stored, vectors)
        return BandValues(obj, (vectors * _normals(obj, stored)).sum(axis=1))
    squares = np.zeros(chosen.shape[1])
    for vectors in chosen:
        squares += np.square(vectors.astype(np.float64) @ part.T).sum(axis=1)
    lengths = np.sqrt(squares)
    return BandValues(obj, _mean_over_cells(stored, lengths[:, None])[:, 0] if is_cells else lengths)


def find_limit(values: Sequence[NDArray[np.floating]], percentile: float) -> float:
    """Return the magnitude that a percentage of all values does not exceed; 100 gives the largest.

    Where that is zero because most of the surface has no detail, it is the largest too.
    """
    import numpy as np

    if not 0.0 <= percentile <= 100.0:
        raise ValueError(f"The percentile is {percentile:g}; it must be from 0 to 100.")
    magnitudes = np.abs(np.concatenate(values))
    return float(np.percentile(magnitudes, percentile)) or float(magnitudes.max())


def _check(obj: bpy.types.Object, stored: StoredBands, choice: BandChoice) -> None:
    """Raise ValueError unless the object has what was chosen."""
    note, name = stored.note, f"‘{obj.name}’"
    if choice.content == "LOW":
        return
    if not 1 <= choice.level <= note.levels:
        have = "level 1 only" if note.levels == 1 else f"levels 1 to {note.levels}"
        raise ValueError(f"{name} has {have}, but level {choice.level} was chosen; choose one that it has.")
    n_bands = note.n_bands[choice.level - 1]
    if choice.content == "BAND" and not 1 <= choice.band <= n_bands:
        raise ValueError(
            f"{name} has bands 1 to {n_bands} at level {choice.level}, but band {choice.band} was chosen; "
            "choose one that it has."
        )


def _normals(obj: bpy.types.Object, stored: StoredBands) -> NDArray[np.float64]:
    """Return the unit vertex normals of the analyzed surface with the object's scale, shape (N, 3)."""

    from ...core.mesh.geometry import vertex_normals

    surface = surface_in_scene(obj, stored.surface.with_vertices(stored.rest))
    # A mirrored object turns its faces over.
    return vertex_normals(surface) * turning(linear_part(obj))


def _mean_over_cells(stored: StoredBands, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Average values of cells, shape (n_cells, k), to their corners, shape (N, k)."""
    import numpy as np

    corners = find_note_cells(stored.surface, stored.note).corners
    n_vertices = stored.surface.n_vertices
    counts = np.maximum(np.bincount(corners.ravel(), minlength=n_vertices), 1)
    sums = [np.bincount(corners.ravel(), np.repeat(column, 4), n_vertices) for column in values.T]
    return np.stack(sums, axis=1) / counts[:, None]
