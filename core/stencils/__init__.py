# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Data-matrix generation: from the one-rings of a mesh to the points under each mask."""

from .make import make_stencil
from .stencil import Stencil

__all__ = ["Stencil", "make_stencil"]
