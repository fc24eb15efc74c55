# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the pictures of a preview come from: what is known at once, a draft, the result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io import mesh_bridge
from .drafts import Picture, compute_pictures
from .known_results import KnownResults
from .latest import Latest

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core.methods.problem import Callback
    from ..run.denoise_job import DenoiseJob, DenoiseOutcome


@dataclass(frozen=True, eq=False)
class Request:
    """What the thread is asked for.

    Attributes
    ----------
    job : DenoiseJob
        What to do.
    has_picture : bool
        Whether something is shown already, so that no draft is needed.
    is_ahead : bool
        Whether nobody has asked for it yet.
    """

    job: DenoiseJob
    has_picture: bool = False
    is_ahead: bool = False


class Shown(NamedTuple):
    """Positions to show, shape (N, 3), or an error; the outcome if these are the result of the job."""

    job: DenoiseJob
    positions: NDArray[np.float32] | None
    outcome: DenoiseOutcome | None
    error: Exception | None


class PictureSource:
    """Computes on a thread what a preview shows. All calls are for the main thread.

    Parameters
    ----------
    compute : callable
        `compute(job, callback, should_stop)` carries a job out; `callback(fraction, change)` is called
        meanwhile. It must not touch Blender.
    recall : callable
        `recall(job)` returns what the same job came to before, or None. It must not touch Blender.

    Attributes
    ----------
    fraction : float
        How much of what is being computed is done, from 0 to 1.
    """

    def __init__(
        self,
        compute: Callable[[DenoiseJob, Callback, Callable[[], bool]], DenoiseOutcome],
        recall: Callable[[DenoiseJob], DenoiseOutcome | None],
    ) -> None:
        self._compute_job, self._recall = compute, recall
        self._known: KnownResults | None = None
        self._last: Request | None = None
        self.fraction = 0.0
        self._latest: Latest[Request, Picture] = Latest(self._compute)

    def request(self, job: DenoiseJob) -> NDArray[np.float32] | None:
        """Ask for a job; return a picture, shape (N, 3), if what is known gives one at once."""
        if self._last is None or not _is_same_but_settings(job, self._last.job):
            self._known = KnownResults(job.surface.vertices)
        assert self._known is not None
        picture = self._known.between(job.settings)
        self._last = Request(job, has_picture=picture is not None)
        self._latest.request(self._last)
        return picture

    def forget(self) -> None:
        """Forget what was asked for and what is known."""
        self._last = self._known = None

    def take(self) -> Shown | None:
        """Return what came of a job since the last call, if it is to be shown.

        Once the result of the last job is there, and nothing else waits, the result at the end of the slider
        *Strength* is asked for, so that wherever it is dragged to there is a picture at once.
        """
        answer = self._latest.take()
        if answer is None or self._last is None or self._known is None:
            return None
        request, picture, last = answer.request, answer.result, self._last
        if not _is_same_but_settings(request.job, last.job):
            return None
        positions = outcome = None
        if picture is not None:
            positions = mesh_bridge.with_moved(request.job.surface, picture.outcome.vertices)
            if picture.is_final:
                outcome = picture.outcome
                self._known.add(request.job.settings, positions)
        if request is last and outcome is not None:
            self._look_ahead(last.job)
        if request is not last and (request.is_ahead or last.has_picture):
            return None
        return Shown(request.job, positions, outcome, answer.error)

    def wait(self, seconds: float) -> bool:
        """Wait for what is being computed, at most so long; return whether that is done."""
        return self._latest.wait(seconds)

    def close(self) -> None:
        """Stop computing."""
        self._latest.close()

    @property
    def has_ended(self) -> bool:
        """Whether the thread has ended; after `close`."""
        return self._latest.has_ended

    def join(self) -> None:
        """Wait until the thread has ended; after `close`."""
        self._latest.join()

    def _look_ahead(self, job: DenoiseJob) -> None:
        """Ask for what should be known too, unless the thread has something else to do."""
        assert self._known is not None
        settings = self._known.farthest(job.settings)
        if settings is not None and not self._latest.is_busy:
            ahead = replace(job, settings=settings)
            self._latest.request(Request(ahead, has_picture=True, is_ahead=True))

    def _compute(
        self, request: Request, should_stop: Callable[[], bool], show: Callable[[Picture], None]
    ) -> Picture:
        """Carry a request out; on the thread."""

        def compute(job: DenoiseJob, callback: Callable[[float, float], bool]) -> DenoiseOutcome:
            return self._compute_job(job, callback, should_stop)

        def note(fraction: float) -> None:
            if not request.is_ahead:
                self.fraction = fraction

        known = self._recall(request.job)
        if known is not None:
            note(1.0)
            return Picture(known, is_final=True)
        return compute_pictures(request.job, compute, show, note, with_draft=not request.has_picture)


def _is_same_but_settings(one: DenoiseJob, two: DenoiseJob) -> bool:
    """Return whether two jobs are made of what was read of the object at the same time."""
    return one.surface is two.surface and one.movable is two.movable and one.region is two.region
