# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Analysis of surfaces into frame coefficients, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..frames import FilterBank
from ..mesh.surface_mesh import SurfaceMesh
from .coefficients import FrameCoefficients
from .frame_transform import FrameTransform
from .make import choose_frame, make_transform

__all__ = [
    "FrameCoefficients",
    "FrameTransform",
    "adjoint",
    "analyze",
    "choose_frame",
    "make_transform",
    "synthesize",
]


def analyze(
    surface: SurfaceMesh,
    frame: str | FilterBank = "AUTO",
    stencil: str = "STRAIGHT",
    levels: int = 1,
) -> FrameCoefficients:
    """Decompose a surface in float64; see `make_transform` for the parameters and errors."""
    return make_transform(surface, frame, stencil, levels).analyze(surface.vertices)


def synthesize(coefficients: FrameCoefficients) -> NDArray[np.floating]:
    """Rebuild positions, shape (N, 3), from coefficients; the inverse of `analyze` on every mesh."""
    return coefficients.transform.synthesize(coefficients)


def adjoint(coefficients: FrameCoefficients) -> NDArray[np.floating]:
    """Apply the adjoint of `analyze`, shape (N, 3); see `FrameTransform.adjoint`."""
    return coefficients.transform.adjoint(coefficients)
