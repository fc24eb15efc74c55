# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many steps of moving vertices until the faces have wanted normals, with what does not change made once."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..denoising.constraints import Constraints
from ..denoising.progress import rms_motion
from ..surface.surface_mesh import SurfaceMesh
from .fit_series import Held, share_of_step, step_series
from .means import Means, padded
from .neighbors import Ragged


class VertexFit:
    """In a step each face pulls its vertices towards the plane through its centroid with the wanted normal.

    A vertex v moves by the mean over its faces f of n_f <n_f, c_f - v>, with centroids c_f. For the
    displacement u that is u <- u + r + mean(n_f <n_f, c_f(u)>) - Q u: r is the step at the start, c_f(u) the
    mean displacement of the corners, and Q = mean(n_f n_f'). All of them are small, so that single precision
    loses nothing, and each face is looked at once. Loose vertices stay.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its faces.
    at_vertex : Ragged
        Faces at each vertex.
    blocks : Blocks
        Threads to work on.
    """

    def __init__(self, surface: SurfaceMesh, at_vertex: Ragged, blocks: Blocks) -> None:
        self.surface, self.blocks = surface, blocks
        self.faces = Means(at_vertex, blocks, is_square=False)
        size = surface.common_face_size()
        self.corners: NDArray[np.int32] | None = None  # (K, F), if all have as many, numbered inside `faces`
        if size:
            place = self.faces.place.take(surface.corner_vertex)
            self.corners = np.ascontiguousarray(place.reshape(-1, size).T)

    def corner_means(self, rows: NDArray[np.floating], begin: int, end: int) -> NDArray[np.floating]:
        """Return the means of the corners of a range of faces, shape (n, 4), from values inside `faces`."""
        if self.corners is not None:
            total = rows.take(self.corners[0, begin:end], axis=0)
            for corner in self.corners[1:, begin:end]:
                total += rows.take(corner, axis=0)
            total *= rows.dtype.type(1.0 / len(self.corners))
            return total
        offset = self.surface.face_offset[begin : end + 1]
        sizes = np.diff(offset)
        filled = sizes > 0
        total = np.zeros((end - begin, rows.shape[1]), rows.dtype)
        if filled.any():
            corners = self.faces.place.take(self.surface.corner_vertex[offset[0] : offset[-1]])
            begins = (offset[:-1] - offset[0])[filled]
            total[filled] = np.add.reduceat(rows.take(corners, axis=0), begins, axis=0)
            total[filled] /= sizes[filled, None].astype(rows.dtype)
        return total

    def steps(self, start: NDArray[np.floating], normals: NDArray[np.floating]) -> VertexSteps:
        """Begin to fit: `start` are positions (3, N), `normals` wanted unit normals (3, F)."""
        return VertexSteps(self, start, normals)


class VertexSteps:
    """A fit that is under way."""

    def __init__(self, fit: VertexFit, start: NDArray[np.floating], normals: NDArray[np.floating]) -> None:
        self._fit, self._start, self._normals = fit, start, np.ascontiguousarray(normals)
        dtype, n_vertices = start.dtype, start.shape[1]
        self._first = np.zeros((n_vertices, 4), dtype)  # r
        self._outer = np.zeros((6, n_vertices), dtype)  # the entries of Q that differ
        self._pull = np.zeros((normals.shape[1], 4), dtype)
        points = fit.faces.inward(padded(start))
        centroids = np.empty((normals.shape[1], 4), dtype)

        def center(begin: int, end: int) -> None:
            centroids[begin:end] = fit.corner_means(points, begin, end)

        fit.blocks.run(center, len(centroids))
        rows = padded(normals)

        def begin(part: slice, members: NDArray[np.int32]) -> None:
            if not len(members):
                return
            arm = centroids.take(members, axis=0)
            arm -= points[part]
            normal = np.ascontiguousarray(np.moveaxis(rows.take(members, axis=0), 2, 0))
            along = normal[0] * arm[..., 0]
            along += normal[1] * arm[..., 1]
            along += normal[2] * arm[..., 2]
            share = dtype.type(1.0 / len(members))
            for i in range(3):
                self._first[part, i] = (normal[i] * along).sum(axis=0) * share
            for entry, (i, j) in enumerate(_ENTRIES):
                self._outer[entry, part] = (normal[i] * normal[j]).sum(axis=0) * share

        fit.faces.for_parts(begin)

    def points(
        self,
        n_steps: int,
        constraints: Constraints | None = None,
        origin: NDArray[np.floating] | None = None,
    ) -> Iterator[tuple[NDArray[np.floating], float]]:
        """Yield positions, shape (3, N), and the rms motion of the vertices, after each step.

        Constraints hold vertices at `origin`, shape (3, N), which is by default where the fit started.
        """
        origin = self._start if origin is None else origin
        displacement = np.zeros_like(self._start)
        for _ in range(n_steps):
            before, displacement = displacement, self.advance(displacement)
            points = self._start + displacement
            if constraints is not None:
                constraints.apply(points, origin)
                displacement = points - self._start
            yield points, rms_motion(displacement, before, self._fit.blocks)

    def advance(self, displacement: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return the displacement, shape (3, N), after another step."""
        faces = self._fit.faces
        rows = faces.inward(padded(displacement))
        pull = self._pulled(rows)

        def step(part: slice, means: NDArray[np.floating]) -> None:
            self._relax(part, rows[part], means)
            means += self._first[part]
            rows[part] += means

        faces.visit(pull, step)
        return np.ascontiguousarray(faces.outward(rows)[:, :3].T)

    def after(
        self,
        n_steps: int,
        constraints: Constraints | None = None,
        origin: NDArray[np.floating] | None = None,
        tick: Callable[[float], None] = lambda _: None,
    ) -> NDArray[np.floating]:
        """Return positions, shape (3, N), next to those after so many steps, in far fewer of them.

        Parameters
        ----------
        n_steps : int
            Number of steps.
        constraints : Constraints, optional
            What may not move freely.
        origin : ndarray, shape (3, N), optional
            Where constraints hold vertices; by default where the fit started.
        tick : callable, optional
            Called `n_steps` times in all, with the rms motion of the vertices or 0.

        Notes
        -----
        A step is u <- G u + r, so that after n of them u is the sum of G^j r for j < n. Where vertices count
        as often as they have faces, I - G is a sum of projections, one for each face, and symmetric with
        eigenvalues between 0 and 1. So the sum is a series of Chebyshev polynomials in 2 G - I whose
        coefficients fall off like a Gaussian of width sqrt(n), and the small ones are left out.

        Constraints are projections as well: with them G is replaced by what they leave of it, and they hold
        vertices from the start, not from the first step on.
        """
        faces, dtype = self._fit.faces, self._start.dtype
        held = Held(constraints, faces.place, dtype)
        current, begin = self._first.copy(), self._start
        if constraints is not None and held:
            begin = self._start.copy()
            constraints.apply(begin, self._start if origin is None else origin)
            rows = faces.inward(padded(begin - self._start))
            if rows.any():
                faces.visit(
                    self._pulled(rows), lambda part, means: self._add_step(part, rows, means, current)
                )
        held.project(current)
        coefficients = [dtype.type(value) for value in step_series(n_steps)]
        total = coefficients[0] * current
        before = current
        for degree, coefficient in enumerate(coefficients[1:], 1):
            following = np.empty_like(current) if degree == 1 else before
            factor = dtype.type(2 if degree == 1 else 4)

            def step(
                part: slice,
                means: NDArray[np.floating],
                current: NDArray[np.floating] = current,
                before: NDArray[np.floating] = before,
                following: NDArray[np.floating] = following,
                degree: int = degree,
                factor: np.floating = factor,
            ) -> None:
                # T_1 = Y T_0 and T_(j + 1) = 2 Y T_j - T_(j - 1), with Y = 2 G - I = I + 2 (G - I).
                self._relax(part, current[part], means)
                means *= factor
                means += current[part]
                if degree > 1:
                    means += current[part]
                    means -= before[part]
                following[part] = means

            faces.visit(self._pulled(current), step)
            held.project(following)
            motion = self._add(coefficient, following, total)
            for _ in range(share_of_step(n_steps, degree, len(coefficients) - 1)):
                tick(motion)
            before, current = current, following
        if len(coefficients) == 1:
            for _ in range(n_steps):
                tick(0.0)
        points = np.empty_like(self._start)

        def move(start: int, stop: int) -> None:
            rows = total.take(faces.place[start:stop], axis=0, mode="clip")
            np.add(begin[:, start:stop], rows[:, :3].T, out=points[:, start:stop])

        self._fit.blocks.run(move, points.shape[1])
        return points

    def _pulled(self, rows: NDArray[np.floating]) -> NDArray[np.floating]:
        """Return n <n, c> of the faces, shape (F, 4), for displacements, shape (N, 4), inside."""
        fit, normals, pull = self._fit, self._normals, self._pull

        def project(begin: int, end: int) -> None:
            middle = fit.corner_means(rows, begin, end)
            normal = normals[:, begin:end]
            along = normal[0] * middle[:, 0]
            along += normal[1] * middle[:, 1]
            along += normal[2] * middle[:, 2]
            for i in range(3):
                np.multiply(normal[i], along, out=pull[begin:end, i])

        fit.blocks.run(project, normals.shape[1])
        return pull

    def _relax(self, part: slice, rows: NDArray[np.floating], means: NDArray[np.floating]) -> None:
        """Subtract Q u from the means of what pulls at some vertices, which makes them (G - I) u."""
        own = np.ascontiguousarray(rows.T)
        outer = self._outer[:, part]
        for i, entries in enumerate(_ROWS):
            product = outer[entries[0]] * own[0]
            product += outer[entries[1]] * own[1]
            product += outer[entries[2]] * own[2]
            means[:, i] -= product

    def _add_step(
        self, part: slice, rows: NDArray[np.floating], means: NDArray[np.floating], to: NDArray[np.floating]
    ) -> None:
        """Add G u of some vertices."""
        self._relax(part, rows[part], means)
        means += rows[part]
        to[part] += means

    def _add(self, factor: np.floating, rows: NDArray[np.floating], total: NDArray[np.floating]) -> float:
        """Add rows to a sum, so many times, and return the rms length of what was added."""

        def kernel(start: int, stop: int) -> float:
            part = factor * rows[start:stop]
            total[start:stop] += part
            part *= part
            return float(part.sum())  # in pairs, so that single precision does

        return float(np.sqrt(sum(self._fit.blocks.run(kernel, len(rows))) / max(len(rows), 1)))


_ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))

_ROWS = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
"""For each row of Q where its entries are."""
