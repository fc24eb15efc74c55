# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the jobs of a preview come to, which runs know too. Any thread may call this."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..run.assembly import assemble
from ..run.denoise_job import DenoiseJob, DenoiseOutcome, compute
from ..run.outcome_memory import keep_outcome, known_outcome
from ..shortage import shortage_told

if TYPE_CHECKING:
    from collections.abc import Callable


def computed(
    job: DenoiseJob, callback: Callable[[float, float], bool], should_stop: Callable[[], bool]
) -> DenoiseOutcome:
    """Carry out a job, with mirrored halves, and keep what it came to."""
    with shortage_told(job.name):
        assembly = assemble([job])
        outcome = compute(assembly.job, callback, should_stop=should_stop)
        keep_outcome(assembly.job, outcome)  # so that Denoise has nothing left to do
        return assembly.split(outcome)[0]


def recalled(job: DenoiseJob) -> DenoiseOutcome | None:
    """Return what the job came to before, in a preview or in a run; None if that is not known."""
    with shortage_told(job.name):
        assembly = assemble([job])
        outcome = known_outcome(assembly.job)
        return None if outcome is None else assembly.split(outcome)[0]
