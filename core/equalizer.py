# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Turn the scales of a surface up and down: one gain for each level of its frame transform."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .arguments import as_identifier, check_frame, takes_mesh
from .blocks import BLOCK_SIZE, Blocks
from .errors import SettingError
from .frames import FilterBank
from .limits.constraints import find_constraints
from .mesh.checks import check_surface
from .mesh.connectivity import Connectivity, check_connectivity, connect_agreeing
from .mesh.normalization import displaced, normalize
from .mesh.surface_mesh import SurfaceMesh
from .precision import as_array
from .settings import DenoiseSettings
from .transform import make_transform
from .value_checks import check_number

HIGHEST_GAIN = 100.0


@takes_mesh
def equalize(
    surface: SurfaceMesh,
    gains: Sequence[float],
    *,
    frame: str | FilterBank = "AUTO",
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
    vertices, faces : array_like
        The surface, or a `SurfaceMesh` in place of both; not modified.
    gains : sequence of float
        One gain for each level, finest first: below 1 smooths that scale, above 1 exaggerates it, 1 keeps it.
    frame, stencil, boundary : str, or FilterBank
        See `DenoiseSettings`; in any case.
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
    FrameletError
        In one sentence, if there is no gain, a gain is not a number from 0 to 100, the weights do not fit,
        the frame does not fit the mesh or is replaced by the stencil, or the mesh is too small for so many
        levels.

    Notes
    -----
    As the transform is linear, S' - S is the inverse transform of {(g_j - 1) high_j, 0}; it is added to the
    positions, so that nothing is lost where gains are 1.
    """
    check_frame(as_identifier(frame), as_identifier(stencil))
    check_gains(gains, weights, surface.n_vertices)
    equalizer = Equalizer(
        surface,
        len(gains),
        frame=frame,
        stencil=stencil,
        boundary=boundary,
        connectivity=connectivity,
        threads=threads,
        dtype=dtype,
    )
    return equalizer.equalized(gains, weights=weights)


class Equalizer:
    """The levels of one surface, for many gains: what takes time is done once.

    Parameters
    ----------
    surface : SurfaceMesh
        The surface; its positions are copied.
    n_levels : int
        Number of levels.
    frame, stencil, boundary, connectivity, threads, dtype
        See `equalize`.
    block_size : int, optional
        Vertices in a block of work for a thread.

    Raises
    ------
    FrameletError
        In one sentence, if the frame does not fit the mesh, or the mesh is too small for so many levels.

    Examples
    --------
    >>> import numpy as np
    >>> from framelet.core import SurfaceMesh
    >>> from framelet.core.equalizer import Equalizer, equalize
    >>> points = [[0, 0, 0.1], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0.2]]
    >>> mesh = SurfaceMesh.from_faces(points, [(0, 1, 2, 3), (1, 4, 5, 2)])
    >>> equalizer = Equalizer(mesh, 1)
    >>> bool(np.allclose(equalizer.equalized([0.5]), equalize(mesh, [0.5])))
    True
    >>> half = mesh.vertices - 0.5 * equalizer.details()[0]
    >>> bool(np.allclose(half, equalizer.equalized([0.5]), atol=1e-6))
    True
    """

    def __init__(
        self,
        surface: SurfaceMesh,
        n_levels: int,
        *,
        frame: str | FilterBank = "AUTO",
        stencil: str = "STRAIGHT",
        boundary: str = "ALONG",
        connectivity: Connectivity | None = None,
        threads: int = 0,
        dtype: DTypeLike = np.float32,
        block_size: int = BLOCK_SIZE,
    ) -> None:
        self.n_levels = n_levels
        self._vertices = surface.vertices.copy()
        self._edge = check_surface(surface)
        self._blocks = Blocks(threads, block_size)
        with self._blocks as blocks:
            check_connectivity(connectivity, surface)
            if connectivity is None or not connectivity.is_oriented:
                surface, connectivity, _ = connect_agreeing(surface, blocks)
            normalized = normalize(surface, connectivity, self._edge)
            transform = make_transform(
                surface.with_vertices(normalized),
                frame,
                stencil,
                n_levels,
                boundary=boundary,
                connectivity=connectivity,
                blocks=blocks,
                dtype=dtype,
                only_used_bands=True,
            )
            self._coefficients = transform.analyze(normalized)
        settings = DenoiseSettings(method="POSITIONS", boundary=as_identifier(boundary))
        self._constraints = find_constraints(surface, connectivity, settings, None, np.dtype(np.float64))

    def equalized(self, gains: Sequence[float], *, weights: ArrayLike | None = None) -> NDArray[np.floating]:
        """Return the positions, shape (N, 3), with a gain for each level, finest first; see `equalize`."""
        shares = check_gains(gains, weights, len(self._vertices))
        if len(gains) != self.n_levels:
            raise SettingError(f"There are {len(gains)} gains for {self.n_levels} levels; give one for each.")
        change = self._change([gain - 1.0 for gain in gains])
        if shares is not None:
            change *= shares
        return displaced(self._vertices, change * self._edge)

    def details(self) -> list[NDArray[np.float64]]:
        """Return what each level adds to the surface, finest first, shape (N, 3) each, in its unit.

        With gains g the positions are those of the surface plus the sum of (g - 1) times these.
        """
        choices = np.eye(self.n_levels)
        return [np.ascontiguousarray(self._edge * self._change(list(choice)).T) for choice in choices]

    def _change(self, factors: Sequence[float]) -> NDArray[np.float64]:
        """Return the sum of all levels times factors, shape (3, N), in mean edge lengths."""
        coefficients = self._coefficients.scaled(factors)
        with self._blocks:
            transform = coefficients.transform
            change = transform.synthesize(coefficients.without_low()).T.astype(np.float64)
        # The rule for borders is linear, so that it can be applied to each level alone.
        self._constraints.apply(change, np.zeros_like(change))
        return change


def check_gains(
    gains: Sequence[float], weights: ArrayLike | None, n_vertices: int
) -> NDArray[np.floating] | None:
    """Raise SettingError unless gains and weights can be used; return the weights as an array."""
    if not np.iterable(gains) or not len(gains):
        raise SettingError("There are no gains; give one for each level, finest first.")
    for level, gain in enumerate(gains, 1):
        check_number(f"The gain of level {level}", gain, 0.0, HIGHEST_GAIN)
    if weights is not None:
        weights = as_array("The weights", weights)
        if weights.shape != (n_vertices,):
            raise SettingError(f"The weights have shape {weights.shape}; expected ({n_vertices},).")
        if weights.dtype.kind not in "biuf":
            raise SettingError(f"The weights are {weights.dtype}; expected real numbers.")
        wrong = ~((weights >= 0.0) & (weights <= 1.0))  # NaN is wrong, too
        if wrong.any():
            vertex = int(np.flatnonzero(wrong)[0])
            raise SettingError(
                f"The weight of vertex {vertex} is {weights[vertex]:g}; it must be from 0 to 1."
            )
    return weights
