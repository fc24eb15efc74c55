# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts: the transform, and what it is made of, neighborhoods and stencils."""

from __future__ import annotations

import numpy as np
from numpy.typing import DTypeLike

from .arguments import as_identifier, check_frame, takes_mesh
from .blocks import Blocks
from .frames import BANKS, FilterBank
from .mesh.connectivity import Connectivity, check_connectivity
from .mesh.connectivity import connect as _connect
from .mesh.surface_mesh import SurfaceMesh
from .stencils import Stencil
from .stencils import make_stencil as _make_stencil
from .transform import FrameCoefficients, FrameTransform
from .transform import make_transform as _make_transform
from .value_checks import check_kind, check_number


@takes_mesh
def connect(mesh: SurfaceMesh, *, threads: int = 0) -> Connectivity:
    """Return the neighborhoods of a mesh, which other functions take so as not to find them again.

    Examples
    --------
    >>> connect(np.eye(3), [[0, 1, 2]]).valence.tolist()
    [2, 2, 2]
    """
    with Blocks(threads) as blocks:
        return _connect(mesh, blocks)


@takes_mesh
def make_stencil(
    mesh: SurfaceMesh,
    connectivity: Connectivity | None = None,
    stencil: str = "STRAIGHT",
    boundary: str = "ALONG",
    *,
    bank: FilterBank | None = None,
    level: int = 0,
    threads: int = 0,
) -> Stencil:
    """Choose the points under the masks of a bank; see `core.stencils.make.make_stencil`."""
    check_connectivity(connectivity, mesh)
    check_kind("The bank", bank, FilterBank, "a FilterBank")
    check_number("The level", level, 0, is_whole=True)
    words = as_identifier(stencil), as_identifier(boundary)
    bank = bank or BANKS["BOX_SPLINE_111"]
    with Blocks(threads) as blocks:
        return _make_stencil(mesh, connectivity or _connect(mesh, blocks), *words, blocks, bank, level)


@takes_mesh
def make_transform(
    mesh: SurfaceMesh,
    frame: str | FilterBank = "AUTO",
    stencil: str = "STRAIGHT",
    levels: int = 1,
    *,
    boundary: str = "ALONG",
    connectivity: Connectivity | None = None,
    threads: int = 0,
    dtype: DTypeLike = np.float64,
    only_used_bands: bool = False,
) -> FrameTransform:
    """Make a `FrameTransform`; see `core.transform.make.make_transform` for the parameters and errors."""
    check_frame(as_identifier(frame), as_identifier(stencil))
    with Blocks(threads) as blocks:
        return _make_transform(
            mesh,
            frame,
            stencil,
            levels,
            boundary=boundary,
            connectivity=connectivity,
            blocks=blocks,
            dtype=dtype,
            only_used_bands=only_used_bands,
        )


@takes_mesh
def analyze(
    mesh: SurfaceMesh, frame: str | FilterBank = "AUTO", stencil: str = "STRAIGHT", levels: int = 1
) -> FrameCoefficients:
    """Decompose a surface in float64; see `make_transform` for the parameters and errors."""
    return make_transform(mesh, frame, stencil, levels).analyze(mesh.vertices)
