# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Taubin's smoothing (SIGGRAPH 1995), as trimesh has it, which the environment of benchmarks has."""

from importlib.util import find_spec

import numpy as np


def is_installed():
    """Tell whether trimesh and SciPy are there."""
    return find_spec("trimesh") is not None and find_spec("scipy") is not None


class Smoother:
    """Runs `trimesh.smoothing.filter_taubin` on a mesh of any polygons.

    trimesh knows triangles only. The smoothing needs positions and a matrix of neighbors alone, so that for
    other polygons it is given the means over their edges.

    Parameters
    ----------
    surface : SurfaceMesh
        The mesh, for its edges.
    """

    def __init__(self, surface):
        from scipy.sparse import csr_array

        n = surface.n_vertices
        ends = np.concatenate((surface.edges, surface.edges[:, ::-1]))
        counts = np.bincount(ends[:, 0], minlength=n)
        weights = 1.0 / counts[ends[:, 0]]
        loose = np.flatnonzero(counts == 0)
        rows = np.concatenate((ends[:, 0], loose))
        columns = np.concatenate((ends[:, 1], loose))
        weights = np.concatenate((weights, np.ones(len(loose))))
        self._means = csr_array((weights, (rows, columns)), shape=(n, n))

    def run(self, positions, shrink, grow, iterations):
        """Return positions, shape (N, 3), after some iterations, of which every second one grows."""
        from trimesh import Trimesh
        from trimesh.smoothing import filter_taubin

        cloud = Trimesh(np.array(positions, np.float64), np.zeros((0, 3), np.int64), process=False)
        filter_taubin(cloud, shrink, grow, iterations, laplacian_operator=self._means)
        return np.array(cloud.vertices)
