# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices at which a mesh is open."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .surface_mesh import SurfaceMesh


def border_vertices(surface: SurfaceMesh) -> NDArray[np.bool_]:
    """Return a mask, shape (N,), of the vertices on open borders: at the ends of edges with one face.

    Parameters
    ----------
    surface : SurfaceMesh
        A mesh; not modified.

    Returns
    -------
    ndarray, shape (N,), bool

    Examples
    --------
    >>> from framelet.core import SurfaceMesh
    >>> two = SurfaceMesh.from_faces([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 2, 0]], [(0, 1, 2, 3)])
    >>> border_vertices(two)
    array([ True,  True,  True,  True, False])
    """
    is_border = np.zeros(surface.n_vertices, bool)
    faces_at_edge = np.bincount(surface.corner_edge, minlength=surface.n_edges)
    is_border[surface.edges[faces_at_edge == 1].reshape(-1)] = True
    return is_border
