# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The multi-level tight wavelet frame transform of a surface (3.7), its inverse and its adjoint."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from inspect import signature
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ..arguments import as_identifier, check_frame, takes_mesh
from ..blocks import Blocks
from ..errors import FrameError, MeshError, TooLargeError
from ..frames import FilterBank
from ..mesh.surface_mesh import SurfaceMesh
from ..precision import as_array
from ..value_checks import check_number, shown
from .coefficients import FrameCoefficients
from .level import Bands, Level, Points, Visit

LARGEST_DENSE = 4096
"""Vertices up to which a transform is written out as a matrix."""


class FrameTransform:
    """A linear transform W with frozen stencils: levels from fine to coarse.

    Parameters
    ----------
    vertices, faces : array_like
        The surface that the stencils are chosen on, or a `SurfaceMesh` in place of both; not modified.
    frame : str or FilterBank
        Name of a frame, in any case, "auto" for the one that fits the faces, or a bank of your own.
    levels : int
        Number of levels.
    stencil : {"STRAIGHT", "MEAN", "ADAPTIVE"}
        Rule at irregular vertices; ADAPTIVE is for the frames "auto", "adaptive" and "pairwise".
    boundary : {"ALONG", "FIXED", "FREE"}
        See `make_stencil`.
    threads : int
        Number of threads that choose the stencils; 0 uses all cores.
    dtype : dtype
        Precision.

    Attributes
    ----------
    levels : tuple of Level
        Its stages, finest first.
    frame : str
        Name of the frame that was made.
    dtype : dtype
        Precision.

    Raises
    ------
    FrameletError
        If the frame is not known, does not fit the mesh or is replaced by the stencil, or the mesh is too
        small for so many levels.

    Examples
    --------
    >>> points = np.stack(np.meshgrid(range(4), range(4), [0.0]), axis=-1).reshape(-1, 3)
    >>> corner = np.array([0, 1, 2, 4, 5, 6, 8, 9, 10])
    >>> W = FrameTransform(points, np.stack((corner, corner + 1, corner + 5, corner + 4), axis=1))
    >>> W
    FrameTransform(LINEAR_SPLINE, 1 level, 16 vertices, 9 bands, not tight)
    >>> low, *details = W.analyze(points)
    >>> low.shape, [bands.shape for bands in details]
    ((16, 3), [(8, 16, 3)])
    >>> np.allclose(W.synthesize([low, *details]), points)
    True
    """

    levels: tuple[Level, ...]
    frame: str
    dtype: np.dtype

    @overload
    def __init__(
        self,
        mesh: SurfaceMesh,
        /,
        frame: str | FilterBank = "auto",
        levels: int = 1,
        *,
        stencil: str = "STRAIGHT",
        boundary: str = "ALONG",
        threads: int = 0,
        dtype: DTypeLike = np.float64,
    ) -> None: ...

    @overload
    def __init__(self, vertices: ArrayLike, faces: ArrayLike, /, *rest: Any, **options: Any) -> None: ...

    def __init__(self, *arguments: Any, **options: Any) -> None:
        made = _made(*arguments, **options)
        self.levels, self.frame, self.dtype = made.levels, made.frame, made.dtype

    @classmethod
    def of_levels(cls, levels: tuple[Level, ...], dtype: DTypeLike, frame: str = "") -> FrameTransform:
        """Return a transform of levels that were made one by one."""
        transform = object.__new__(cls)
        transform.levels, transform.dtype, transform.frame = levels, np.dtype(dtype), frame
        return transform

    def __repr__(self) -> str:
        n, n_levels = self.n_vertices, len(self.levels)
        bands = 1 + sum(level.n_high for level in self.levels)
        return (
            f"FrameTransform({self.frame}, {n_levels} level{'s' * (n_levels != 1)}, {n} vertices, "
            f"{bands} bands, {'tight' if self.is_tight else 'not tight'})"
        )

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return self.levels[0].n_vertices

    @property
    def is_tight(self) -> bool:
        """Whether W is known to keep energy, |W S|^2 = |S|^2, with respect to `measures`."""
        return all(level.is_tight for level in self.levels)

    def analyze(self, vertices: ArrayLike) -> FrameCoefficients:
        """Decompose positions, shape (N, 3), into frame coefficients W S.

        They are also a sequence of plain arrays, coarse to fine: the low-pass (N, 3), then the high bands of
        each level, (H, sites, 3).
        """
        positions = self.positions_of(vertices)
        low = np.ascontiguousarray(positions.T, self.dtype)
        chunks: list[list[Bands]] = []
        for level in self.levels:
            kept: list[Bands] = [low] * len(level.sites)

            def keep(index: int, chunk: Bands, kept: list[Bands] = kept) -> None:
                kept[index] = chunk.copy()

            low, _ = level.forward(low, keep)
            chunks.append(kept)
        return FrameCoefficients(np.ascontiguousarray(low.T), chunks, self)

    def positions_of(self, vertices: ArrayLike) -> NDArray[Any]:
        """Return positions as an array; raise MeshError unless they are numbers of shape (N, 3)."""
        positions = as_array("The positions", vertices, MeshError)
        if positions.shape != (self.n_vertices, 3):
            raise MeshError(
                f"The positions have shape {positions.shape}; the transform needs ({self.n_vertices}, 3)."
            )
        if positions.dtype.kind not in "biuf":
            raise MeshError(f"The positions are {positions.dtype}; expected real numbers.")
        return positions

    def _coefficients(self, given: FrameCoefficients | Sequence[ArrayLike]) -> FrameCoefficients:
        """Return coefficients that are given as plain arrays, coarse to fine, by chunks."""
        if isinstance(given, FrameCoefficients):
            return given
        if not isinstance(given, Sequence | np.ndarray) or not np.iterable(given):
            raise FrameError(f"The coefficients are {shown(given)}; give the arrays that `analyze` returned.")
        arrays = [as_array("The coefficients", array, FrameError) for array in given]
        if len(arrays) != len(self.levels) + 1:
            raise FrameError(
                f"There are {len(arrays)} arrays of coefficients; expected the low-pass and "
                f"{len(self.levels)} of high bands."
            )
        expected = [(level.n_high, level.n_sites, 3) for level in reversed(self.levels)]
        for array, shape in zip(arrays, [(self.n_vertices, 3), *expected], strict=True):
            if array.dtype.kind not in "biuf":
                raise FrameError(f"The coefficients are {array.dtype}; expected real numbers.")
            if array.shape != shape:
                raise FrameError(f"Coefficients have shape {array.shape}; expected {shape}.")
        chunks = [
            [
                np.ascontiguousarray(bands[:n, sites].transpose(2, 0, 1), self.dtype)
                for sites, n in zip(level.sites, level.chunk_bands, strict=True)
            ]
            for level, bands in zip(self.levels, reversed(arrays[1:]), strict=True)
        ]
        return FrameCoefficients(arrays[0].astype(self.dtype), chunks, self)

    def synthesize(self, coefficients: FrameCoefficients | Sequence[ArrayLike]) -> NDArray[np.floating]:
        """Rebuild positions, shape (N, 3), from frame coefficients; `synthesize(analyze(S))` is S."""
        return self._upwards(
            coefficients, lambda level, low, chunks: level.backward(low, level.pending(chunks))
        )

    def adjoint(self, coefficients: FrameCoefficients | Sequence[ArrayLike]) -> NDArray[np.floating]:
        """Apply the adjoint W', the transposed matrix, shape (N, 3): <W S, c> = <S, W' c> in every frame."""
        return self._upwards(coefficients, lambda level, low, chunks: level.adjoint(low, chunks))

    def weighted_adjoint(self, coefficients: FrameCoefficients | Sequence[ArrayLike]) -> NDArray[np.floating]:
        """Apply the adjoint with respect to `measures`, shape (N, 3): <W S, c>_m' = <S, W* c>_m.

        With masks that fit the valence it is the inverse. In other frames all measures are 1, and it is
        the same as `adjoint`.
        """
        return self._upwards(coefficients, lambda level, low, chunks: level.weighted_adjoint(low, chunks))

    def _upwards(
        self,
        given: FrameCoefficients | Sequence[ArrayLike],
        step: Callable[[Level, Points, Sequence[Bands]], Points],
    ) -> NDArray[np.floating]:
        """Go from the coarsest level to the finest by `step(level, low, high bands)`; return shape (N, 3)."""
        coefficients = self._coefficients(given)
        low = np.ascontiguousarray(coefficients.low.T, self.dtype)
        for level, chunks in zip(reversed(self.levels), reversed(coefficients.chunks), strict=True):
            low = step(level, low, chunks)
        return np.ascontiguousarray(low.T)

    def to_dense(self) -> NDArray[np.float64]:
        """Return W as a matrix, shape (M, N), of a small mesh.

        Rows are the low-pass, then the high bands from coarse to fine, band by band. Rows of bands that a
        vertex does not have are zero.

        Raises
        ------
        TooLargeError
            If there are more than `LARGEST_DENSE` vertices.
        """
        n = self.n_vertices
        if n > LARGEST_DENSE:
            raise TooLargeError(f"There are {n:,} vertices; matrices are for {LARGEST_DENSE:,} at most.")
        columns = []
        for start in range(0, n, 3):
            unit = np.zeros((n, 3))
            stop = min(start + 3, n)
            unit[np.arange(start, stop), np.arange(stop - start)] = 1.0
            found = np.concatenate([array.reshape(-1, 3) for array in self.analyze(unit)])
            columns.append(found[:, : stop - start].astype(np.float64))
        return np.concatenate(columns, axis=1)

    def frame_bounds(self, steps: int = 100) -> tuple[float, float]:
        """Return A and B with A |S|^2 <= |W S|^2 <= B |S|^2 for all S.

        Parameters
        ----------
        steps : int
            Steps of Lanczos' method. With as many steps as vertices the bounds are exact, up to rounding;
            with less they are inside, A from above and B from below, and B much closer.

        Returns
        -------
        tuple of float
            Both are 1 if the frame is tight and all measures are 1.
        """
        check_number("The number of steps", steps, 1, is_whole=True)
        n = self.n_vertices
        vector = np.random.default_rng(0).normal(size=n)
        basis = np.zeros((min(steps, n), n))
        diagonal: list[float] = []
        beside: list[float] = []
        length = float(np.linalg.norm(vector))
        for step in range(len(basis)):
            basis[step] = vector / length
            column = np.zeros((n, 3))
            column[:, 0] = basis[step]
            vector = self.adjoint(self.analyze(column))[:, 0].astype(np.float64)
            diagonal.append(float(vector @ basis[step]))
            for _ in range(2):  # twice is enough
                vector -= basis[: step + 1].T @ (basis[: step + 1] @ vector)
            length = float(np.linalg.norm(vector))
            if length < 1e-12 * max(map(abs, diagonal)):
                break
            beside.append(length)
        size = len(diagonal)
        matrix = np.diag(diagonal)
        for side in (-1, 1):
            matrix += np.diag(beside[: size - 1], side)
        values = np.linalg.eigvalsh(matrix)
        return float(values[0]), float(values[-1])

    def measures(self) -> list[NDArray[np.floating]]:
        """Return the measures at the input of each level and at the end, L + 1 arrays of shape (N,)."""
        one = np.ones(self.levels[0].n_vertices)
        return [*(getattr(level, "measure", one) for level in self.levels), one]

    def rebuild_changes(self, low: Points, visits: Sequence[Visit]) -> Points:
        """Analyze positions, let each level's visit turn its bands into changes of them, and rebuild those.

        Parameters
        ----------
        low : ndarray, shape (3, N)
            Positions; not modified.
        visits : sequence of callable
            For each level, replaces high bands by what is to be added to them.

        Returns
        -------
        ndarray, shape (3, N)
            What is to be added to the positions: as everything is linear and the positions are rebuilt
            perfectly, they need not go all the way. Valid until this thread uses the transform again.
        """
        waiting = []
        for index, (level, visit) in enumerate(zip(self.levels, visits, strict=True), 1):
            low, pending = level.forward(low, visit, needs_low=index < len(self.levels))
            waiting.append(pending)
        change: Points | None = None
        del low, pending
        for level in reversed(self.levels):
            change = level.backward(change, waiting.pop())
        assert change is not None
        return change


@takes_mesh
def _made(
    mesh: SurfaceMesh,
    frame: str | FilterBank = "auto",
    levels: int = 1,
    *,
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    threads: int = 0,
    dtype: DTypeLike = np.float64,
) -> FrameTransform:
    """Return the transform that `FrameTransform` becomes."""
    from .make import make_transform  # which makes transforms by `of_levels`

    check_frame(as_identifier(frame), as_identifier(stencil))
    with Blocks(threads) as blocks:
        return make_transform(mesh, frame, stencil, levels, boundary=boundary, blocks=blocks, dtype=dtype)


FrameTransform.__signature__ = signature(_made)  # type: ignore[attr-defined]
