# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Analysis of surfaces into frame coefficients, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import FrameError
from ..value_checks import shown
from .coefficients import FrameCoefficients
from .frame_transform import FrameTransform
from .make import choose_frame, make_transform

__all__ = [
    "FrameCoefficients",
    "FrameTransform",
    "adjoint",
    "choose_frame",
    "make_transform",
    "synthesize",
]


def synthesize(coefficients: FrameCoefficients) -> NDArray[np.floating]:
    """Rebuild positions, shape (N, 3), from coefficients; the inverse of `analyze` on every mesh."""
    return _transform_of(coefficients).synthesize(coefficients)


def adjoint(coefficients: FrameCoefficients) -> NDArray[np.floating]:
    """Apply the adjoint of `analyze`, shape (N, 3); see `FrameTransform.adjoint`."""
    return _transform_of(coefficients).adjoint(coefficients)


def _transform_of(coefficients: FrameCoefficients) -> FrameTransform:
    """Return the transform that made coefficients."""
    if not isinstance(coefficients, FrameCoefficients):
        raise FrameError(f"The coefficients are {shown(coefficients)}; give what `analyze` returned.")
    return coefficients.transform
