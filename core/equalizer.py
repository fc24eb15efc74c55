# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Turn the scales of a surface up and down: one gain for each level of its frame transform."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .blocks import Blocks
from .errors import SettingError
from .limits.constraints import find_constraints
from .mesh.checks import check_surface
from .mesh.connectivity import Connectivity, connect
from .mesh.normalization import displaced, normalize
from .mesh.surface_mesh import SurfaceMesh
from .settings import DenoiseSettings
from .transform import choose_frame, make_transform

HIGHEST_GAIN = 100.0


def equalize(
    surface: SurfaceMesh,
    gains: Sequence[float],
    *,
    frame: str = "AUTO",
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    weights: ArrayLike | None = None,
    connectivity: Connectivity | None = None,
    threads: int = 0,
    dtype: DTypeLike = np.float32,
) -> NDArray[np.floating]:
    """Multiply the details of each level by a gain and rebuild the surface.

    Parameters
    ----------
    surface : SurfaceMesh
        The surface; not modified.
    gains : sequence of float
        One gain for each level, finest first: below 1 smooths that scale, above 1 exaggerates it, 1 keeps it.
    frame, stencil, boundary : str
        See `DenoiseSettings`.
    weights : array_like, shape (N,), optional
        How much of the change each vertex takes, 0 to 1; all of it by default.
    connectivity : Connectivity, optional
        Neighborhoods of the mesh, if they are known already.
    threads : int
        Number of threads; 0 uses all cores.
    dtype : dtype, optional
        Precision of the transform.

    Returns
    -------
    ndarray, shape (N, 3), dtype of the vertices
        New positions; with all gains 1 the same bits.

    Raises
    ------
    SettingError
        In one sentence, if there is no gain, a gain is not a number from 0 to 100, the weights do not fit,
        the frame does not fit the mesh, or the mesh is too small for so many levels.

    Notes
    -----
    As the transform is linear, S' - S is the inverse transform of {(g_j - 1) high_j, 0}; it is added to the
    positions, so that nothing is lost where gains are 1.
    """
    weights = None if weights is None else np.asarray(weights, np.float64)
    _check(gains, weights, surface.n_vertices)
    edge = check_surface(surface)
    with Blocks(threads) as blocks:
        connectivity = connectivity or connect(surface, blocks)
        normalized = normalize(surface, connectivity, edge)
        transform = make_transform(
            surface.with_vertices(normalized),
            choose_frame(frame, connectivity),
            stencil,
            len(gains),
            boundary=boundary,
            connectivity=connectivity,
            blocks=blocks,
            dtype=dtype,
            only_used_bands=True,
        )
        coefficients = transform.analyze(normalized).scaled([gain - 1.0 for gain in gains])
        change = transform.synthesize(coefficients.without_low()).T.astype(np.float64)
    settings = DenoiseSettings(method="POSITIONS", boundary=boundary)
    constraints = find_constraints(surface, connectivity, settings, None, change.dtype)
    constraints.apply(change, np.zeros_like(change))
    if weights is not None:
        change *= weights
    return displaced(surface.vertices, change, np.zeros_like(change), edge)


def _check(gains: Sequence[float], weights: NDArray[np.floating] | None, n_vertices: int) -> None:
    """Raise SettingError unless gains and weights can be used."""
    if not len(gains):
        raise SettingError("There are no gains; give one for each level, finest first.")
    for level, gain in enumerate(gains, 1):
        if not 0.0 <= gain <= HIGHEST_GAIN:  # also refuses NaN
            raise SettingError(
                f"The gain of level {level} is {gain:g}; it must be from 0 to {HIGHEST_GAIN:g}."
            )
    if weights is not None:
        if np.shape(weights) != (n_vertices,):
            raise SettingError(f"The weights have shape {np.shape(weights)}; expected ({n_vertices},).")
        wrong = ~((weights >= 0.0) & (weights <= 1.0))  # NaN is wrong, too
        if wrong.any():
            vertex = int(np.flatnonzero(wrong)[0])
            raise SettingError(
                f"The weight of vertex {vertex} is {weights[vertex]:g}; it must be from 0 to 1."
            )
