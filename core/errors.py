# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The errors of this package. All are ValueErrors whose text is one sentence for people."""

from __future__ import annotations


class FrameletError(ValueError):
    """What was given cannot be worked on; the sentence says what is wrong and what to do."""


class MeshError(FrameletError):
    """The mesh cannot be worked on: its arrays do not fit each other, or it is empty or has no size."""


class SettingError(FrameletError):
    """A setting has a value that is not allowed, or the method does not use it."""


class FrameError(FrameletError):
    """The frame is not known or does not fit the mesh, or the mesh is too small for so many levels."""


class RegionError(FrameletError):
    """What limits a run does not fit the mesh, or leaves nothing that may move."""


class TooLargeError(FrameletError):
    """The run needs more memory than it may take."""
