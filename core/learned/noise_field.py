# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise of a surface as a field: how strong and how wide it is at each vertex.

It is what a run took away: the displacement along the normals. Its mean square around a vertex is the
strength there. Noise that is smooth over some edges is alike at neighbors: for a Gaussian of deviation w the
correlation at a distance d is exp(-d^2 / 4 w^2), which at one edge gives the width w.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blocks import Blocks
from ..mesh.checks import check_surface
from ..mesh.connectivity import connect_agreeing
from ..mesh.normalization import normalize
from ..mesh.surface_mesh import SurfaceMesh
from ..noise.estimate import NoiseEstimate

if TYPE_CHECKING:
    from .engine import FaceEngine
    from .measured import Measured

SPIKE, TIMES_AROUND = 1.0, 4.0
"""Displacement in local edge lengths, and in strengths of the noise around, of a spike."""


HEAVY_TAILS = 6.0
"""Kurtosis of the displacements from which the noise is impulsive: twice that of Gaussian noise."""


class NoiseField(NamedTuple):
    """Noise at each vertex, shape (N,): standard deviation, in units of the positions, and width in edges."""

    strength: NDArray[np.float32]
    width: NDArray[np.float32]


@dataclass(frozen=True)
class NoiseBelief(NoiseEstimate):
    """What a run took for noise.

    Attributes
    ----------
    sigma_low, sigma_high : float
        Strength of the noise in its quietest and strongest tenth of the surface, in scene units.
    width : float
        How wide it is: standard deviation of the kernel that would make it of white noise, in edges; 0 for
        white noise.
    spikes : float
        Share of the vertices that were far off alone.
    clean : float
        Share of the vertices that were clean, and stayed.
    shared, wide : float
        Share of the faces where neighbors share what a pass for fine noise takes away, which is relief or
        wide noise, and of those where it was taken for wide noise.
    along : float
        What was taken away along the surface, root mean square in mean edge lengths.
    steps : str
        "VOXELS" or "TERRACES" for exact steps, which may be meant (see `find_steps`), "ROUNDED" for
        coordinates whose rounding was taken for wide noise, else "".
    """

    sigma_low: float
    sigma_high: float
    width: float
    spikes: float
    clean: float
    shared: float = 0.0
    wide: float = 0.0
    along: float = 0.0
    steps: str = ""

    @property
    def is_clean(self) -> bool:
        """Whether there was no noise anywhere."""
        return self.clean >= 1.0

    @property
    def is_doubtful(self) -> bool:
        """Whether what looks clean, and is no step, may be noise several edges wide: relief looks alike."""
        return self.is_clean and self.shared > 0.5 and not self.steps


def noise_field(surface: SurfaceMesh, vertices: NDArray[np.floating]) -> NoiseField:
    """Return the noise that was taken away from a mesh.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh before.
    vertices : ndarray, shape (N, 3)
        Its positions after.

    Returns
    -------
    NoiseField
        `strength` in scene units; 0 at vertices without a face.

    Raises
    ------
    ValueError
        If the positions have another shape, or the mesh has no faces.

    Examples
    --------
    >>> import numpy as np
    >>> from framelet.core import SurfaceMesh, noise_field
    >>> grid = np.stack(np.meshgrid(range(9), range(9), [0.0]), axis=-1).reshape(-1, 3)
    >>> corner = np.arange(72).reshape(8, 9)[:, :8].ravel()
    >>> faces = np.stack((corner, corner + 1, corner + 10, corner + 9), axis=1)
    >>> mesh = SurfaceMesh.from_faces(grid + [0, 0, 0.25], faces)
    >>> field = noise_field(mesh, grid)
    >>> np.allclose(field.strength, 0.25)
    True
    """
    from .engine import FaceEngine

    blocks = Blocks()
    with blocks:
        edge = check_surface(surface, blocks)
        surface, connectivity, _ = connect_agreeing(surface, blocks)
        engine = FaceEngine(surface, connectivity, blocks)
        before = normalize(surface, connectivity, edge, blocks)
        moved = surface.with_vertices(vertices).vertices.astype(np.float64)
        moved -= surface.vertices
        after = before + moved / edge
        strength, width = find_field(
            np.ascontiguousarray(before.T, np.float32), np.ascontiguousarray(after.T, np.float32), engine
        )
    strength[connectivity.is_loose] = 0
    return NoiseField(strength * np.float32(edge), width)


def find_field(
    before: NDArray[np.float32],
    after: NDArray[np.float32],
    engine: FaceEngine,
    measured: Measured | None = None,
) -> NoiseField:
    """Return the noise that was taken away between two positions, shape (3, N) each."""
    if not engine.graph.n_faces:
        nothing = np.zeros(before.shape[1], np.float32)
        return NoiseField(nothing, nothing.copy())
    strength, correlation = engine.residual(before, after, measured)
    is_wide = correlation > 0.02
    width = np.zeros_like(strength)
    width[is_wide] = 0.5 / np.sqrt(-np.log(np.minimum(correlation[is_wide], np.float32(0.999))))
    return NoiseField(strength, width)


def find_belief(
    before: NDArray[np.float32],
    after: NDArray[np.float32],
    unit: NDArray[np.float32],
    engine: FaceEngine,
    edge: float,
    share_clean: float,
    measured: Measured | None = None,
) -> NoiseBelief:
    """Summarize what a run took for noise.

    Parameters
    ----------
    before, after : ndarray, shape (3, N), float32
        Positions in mean edge lengths.
    unit : ndarray, shape (N,), float32
        Local edge lengths, in the same unit.
    engine : FaceEngine
        Tables of the mesh.
    edge : float
        Mean edge length in scene units.
    share_clean : float
        Share of the vertices that were found to be clean.
    measured : Measured, optional
        Where vertices may move; by default everywhere.
    """
    step = after - before
    distance = np.sqrt((step * step).sum(axis=0))
    moved = np.flatnonzero(distance)
    if not len(moved):
        return NoiseBelief(0.0, 0.0, 0.0, False, 0.0, 0.0, 0.0, 0.0, 0.0, share_clean)
    field = find_field(before, after, engine, measured)
    strength, distance, own_unit = field.strength[moved], distance[moved], unit[moved]
    low, high = (float(value) for value in np.quantile(strength, (0.1, 0.9)))
    in_edges = strength / own_unit
    weights = np.square(in_edges, dtype=np.float64)
    is_spike = (distance > SPIKE * own_unit) & (distance > TIMES_AROUND * np.median(in_edges) * own_unit)
    n_vertices = before.shape[1] if measured is None else int(np.count_nonzero(measured.movable))
    squares = np.square(distance / own_unit, dtype=np.float64)
    kurtosis = float((squares**2).mean() / squares.mean() ** 2)
    rms = float(np.sqrt(np.square(strength, dtype=np.float64).mean())) * edge
    rms_edges = float(np.sqrt(weights.mean()))
    return NoiseBelief(
        sigma=rms,
        sigma_edges=rms_edges,
        sigma_clean_edges=rms_edges,
        is_impulsive=kurtosis > HEAVY_TAILS,
        rms=rms,
        sigma_low=low * edge,
        sigma_high=high * edge,
        width=float((weights * field.width[moved]).sum() / max(weights.sum(), 1e-30)),
        spikes=float(np.count_nonzero(is_spike)) / n_vertices,
        clean=share_clean,
    )
