# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a preview of the method AUTO shows for a new strength until it is computed. Knows no Blender.

AUTO takes seconds on large meshes, and every strength is a run of its own. Between two strengths that are
known already, the mean of their results, weighted by nearness, is close to what will come.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .denoise_job import DenoiseJob

MOST = 8
"""Results that are kept; the oldest is dropped first."""


class StrengthDrafts:
    """Results of one mesh for several strengths, all other settings and the region being the same."""

    def __init__(self) -> None:
        self._like: DenoiseJob | None = None
        self._known: dict[float, NDArray[np.float32]] = {}

    def note(self, job: DenoiseJob, positions: NDArray[np.float32]) -> None:
        """Keep a result, shape (N, 3), which must not be changed afterwards."""
        if not _is_automatic(job):
            return
        if not self._is_like(job):
            self._like = job
            self._known.clear()
        self._known.pop(job.settings.strength, None)
        self._known[job.settings.strength] = positions
        while len(self._known) > MOST:
            del self._known[next(iter(self._known))]

    def draft(self, job: DenoiseJob) -> NDArray[np.float32] | None:
        """Return what a job is likely to give, shape (N, 3); None if nothing is known that is like it.

        Strength 0 is known to change nothing; beyond the largest known strength its result is taken.
        """
        if not _is_automatic(job) or not self._is_like(job):
            return None
        known = {0.0: job.surface.vertices, **self._known}
        wanted = job.settings.strength
        below = max(strength for strength in known if strength <= wanted)
        above = min((strength for strength in known if strength >= wanted), default=below)
        if above == below:
            return known[below]
        share = known[below].dtype.type((wanted - below) / (above - below))
        return known[below] + share * (known[above] - known[below])

    def _is_like(self, job: DenoiseJob) -> bool:
        """Tell whether a job differs from those before in nothing but the strength."""
        like = self._like
        return (
            like is not None
            and like.region is job.region
            and like.settings == job.settings.with_changes(strength=like.settings.strength)
        )


def _is_automatic(job: DenoiseJob) -> bool:
    """Tell whether the strength is what the method goes by."""
    return job.settings.method == "AUTO"
