# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run over several objects: read all, compute on any thread, write all. No user interface.

`begin`, `start`, `tick` and `finish`, or `cancel` in between, are plain calls on the main thread; the modal
operator is one way to make them. Nothing is written before `finish`, and nothing if anything was changed
meanwhile.
"""

from __future__ import annotations

import traceback
from enum import Enum
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

from bpy.app.translations import pgettext_iface as iface_

from ..shortage import reserve_for_writing, shortage_told
from .assembly import assemble
from .denoise_job import DenoiseJob, DenoiseOutcome, MeasuredReport, compute, with_amount
from .denoise_object import read_job, write_outcome
from .outcome_memory import keep_outcome, known_outcome
from .run_guard import Mark, find_object, mark_of, what_changed
from .worker import Worker

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import bpy

    from ...core.settings import DenoiseSettings
    from ..properties.region_options import RegionOptions

LEAST_SHARE, LEAST_SECONDS = 0.05, 2.0
"""Share of the work, and time, from which on the pace says how long the rest takes."""

UNCHANGED = "nothing was changed"


class State(Enum):
    """How a run stands."""

    READING = "it was read, and waits for `start`"
    RUNNING = "it is computing"
    READY = "it is computed, and waits for `finish`"
    FINISHED = "it is written"
    CANCELED = "it was canceled by the user"
    FAILED = "it came to nothing; `reason` says why"


class Written(NamedTuple):
    """An object that was denoised, the object that has the result, the measured report, and more words."""

    original: bpy.types.Object
    obj: bpy.types.Object
    measured: MeasuredReport
    note: str = ""


class DenoiseRun:
    """One run; `begin_run` makes it.

    Attributes
    ----------
    state : State
        Where it is.
    failures : list of str
        Sentences about objects that could not be denoised.
    reason : str
        If the run failed, one sentence that says why.
    """

    def __init__(
        self, jobs: list[tuple[Mark, DenoiseJob]], failures: list[str], *, is_together: bool = False
    ) -> None:
        self.state = State.READING
        self.failures = failures
        self.reason = ""
        self._jobs = jobs
        self._at = 0
        self._is_together = is_together
        self._is_touched = self._is_started = False
        self._began: float | None = None
        self._progress: Callable[[float], None] | None = None
        self._worker: Worker[list[DenoiseOutcome | str]] = Worker(self._compute)

    @property
    def fraction(self) -> float:
        """Share of the work that is done, from 0 to 1."""
        return self._worker.fraction

    @property
    def seconds_left(self) -> float | None:
        """How long the rest takes at the pace so far; None while that is a guess, or nothing is left."""
        if self._began is None or not LEAST_SHARE <= self.fraction < 1.0:
            return None
        passed = monotonic() - self._began
        return None if passed < LEAST_SECONDS else passed * (1.0 - self.fraction) / self.fraction

    @property
    def is_active(self) -> bool:
        """Whether something is still to come."""
        return self.state in {State.READING, State.RUNNING, State.READY}

    @property
    def text(self) -> str:
        """What is being done, for people."""
        name = self._jobs[self._at][1].name
        if self._is_together and len(self._jobs) > 1:
            return iface_("Denoising {number} objects as one").format(number=len(self._jobs))
        if len(self._jobs) == 1:
            return iface_("Denoising ‘{name}’").format(name=name)
        text = iface_("Denoising ‘{name}’ ({number} of {total})")
        return text.format(name=name, number=self._at + 1, total=len(self._jobs))

    def start(self) -> None:
        """Begin to compute on a thread."""
        self.state = State.RUNNING
        self._began = monotonic()
        self._worker.start()
        self._is_started = True

    def run_here(self, progress: Callable[[float], None] | None = None) -> None:
        """Compute on the calling thread, and call `progress(fraction)` meanwhile."""
        self.state, self._is_started = State.RUNNING, True
        self._progress = progress
        self._worker.run_here()
        self._take_results()

    def touch(self, touched: set[int]) -> None:
        """Note the session numbers of objects and meshes that may have been edited.

        If they are those of the run, the next tick looks in detail.
        """
        if any(not touched.isdisjoint((mark.object_uid, mark.mesh_uid)) for mark, _ in self._jobs):
            self._is_touched = True

    def tick(self) -> State:
        """Look whether the run is done, and whether its objects are still what was read. Call it often."""
        if self.state is not State.RUNNING:
            return self.state
        is_done = self._worker.is_done
        is_touched, self._is_touched = self._is_touched, False
        for mark, job in self._jobs:
            # Reading a level of Multires counts as touching it, so that it is done once, at the end.
            in_detail = is_done or (is_touched and not job.is_level)
            change = what_changed(mark, job.read, in_detail=in_detail)
            if change is not None:
                self.drop(change)
                return self.state
        if is_done:
            self._take_results()
        return self.state

    def cancel(self) -> None:
        """Give up on behalf of the user; nothing is written. The thread ends a little later."""
        if self.is_active:
            self.state = State.CANCELED
            self._worker.stop()

    def drop(self, change: str) -> None:
        """Give up because of what happened meanwhile, as in “‘Cube’ was deleted”."""
        if self.is_active:
            self._fail(f"{change} while Framelet was running, so that the run was dropped; {UNCHANGED}.")

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for the thread, at most so long; return whether it has ended."""
        return not self._is_started or self._worker.wait(seconds)

    def finish(self) -> list[Written]:
        """Write the results of a run that is ready, and return what was done.

        Where there is no memory to write, or Blender does not take a result, `failures` says so; a run that
        could write nothing has FAILED.
        """
        if self.state is not State.READY:
            raise RuntimeError(f"The run cannot be finished: {self.state.value}.")
        self.state = State.FINISHED
        written = []
        for (mark, job), outcome in zip(self._jobs, self._worker.result(), strict=True):
            if isinstance(outcome, DenoiseOutcome):
                obj = find_object(mark)
                assert obj is not None  # `tick` has looked, and nothing happened since
                try:
                    with shortage_told(obj.name):
                        reserve_for_writing(obj)
                    output = write_outcome(obj, job, outcome)
                except ValueError as error:
                    self.failures.append(str(error))
                    continue
                measured = with_amount(outcome.measured, output.amount)
                written.append(Written(obj, output.obj, measured, output.note))
        if not written:
            self.state, self.reason = State.FAILED, " ".join(self.failures)
        return written

    def _take_results(self) -> None:
        """Go over from the thread's results to READY, or FAILED if there are none."""
        try:
            outcomes = self._worker.result()
        except MemoryError:
            self._fail(f"There is not enough memory for this mesh; {UNCHANGED}.")
            return
        except Exception as error:
            traceback.print_exception(error)
            kind = type(error).__name__
            self._fail(
                f"An unexpected error stopped the run ({kind}: {error}); {UNCHANGED}. Please report it."
            )
            return
        self.failures += dict.fromkeys(outcome for outcome in outcomes if isinstance(outcome, str))
        if any(isinstance(outcome, DenoiseOutcome) for outcome in outcomes):
            self.state = State.READY
        else:
            self._fail(" ".join(self.failures))

    def _fail(self, reason: str) -> None:
        self.state, self.reason = State.FAILED, reason
        self._worker.stop()

    def _compute(self, worker: Worker[list[DenoiseOutcome | str]]) -> list[DenoiseOutcome | str]:
        """Carry out the jobs one after the other; the sentence of an error stands for an outcome."""
        jobs = [job for _, job in self._jobs]
        groups = [jobs] if self._is_together else [[job] for job in jobs]
        sizes = [sum(job.surface.n_vertices for job in group) for group in groups]
        outcomes: list[DenoiseOutcome | str] = []
        for number, group in enumerate(groups):
            self._at = number

            def advance(share: float, change: float, number: int = number) -> bool:
                fraction = (sum(sizes[:number]) + share * sizes[number]) / sum(sizes)
                if self._progress is not None:
                    self._progress(fraction)
                return worker.advance(fraction, change)

            try:
                assembly = assemble(group)
                outcome = known_outcome(assembly.job)
                if outcome is None:
                    outcome = compute(assembly.job, advance, worker.should_stop)
                    keep_outcome(assembly.job, outcome)
                advance(1.0, 0.0)
                outcomes += assembly.split(outcome)
            except ValueError as error:
                outcomes += [str(error)] * len(group)
            if worker.should_stop():
                break
        return outcomes


def begin_run(
    objects: Iterable[bpy.types.Object],
    settings: DenoiseSettings,
    output: str = "IN_PLACE",
    options: RegionOptions | None = None,
    *,
    amount: float = 1.0,
    from_original: bool | None = None,
) -> DenoiseRun:
    """Read all that a run needs.

    Parameters
    ----------
    objects : iterable of bpy.types.Object
        One for each mesh.
    settings : DenoiseSettings
        What to do with each.
    output : str
        One of `output_choices.OUTPUTS`.
    options : RegionOptions, optional
        What limits the run.
    amount : float
        How much of what is moved is written.
    from_original : bool or None
        True starts from where the vertices were before the last run, where a mesh still is what that made;
        False from its result, also from one in a modifier; None from the mesh itself.

    Raises
    ------
    ValueError
        With a sentence for each object, if none can be denoised.
    """
    jobs, failures = [], []
    for obj in objects:
        try:
            with shortage_told(obj.name):
                job = read_job(obj, settings, output, options, amount=amount, from_original=from_original)
            jobs.append((mark_of(obj), job))
        except ValueError as error:
            failures.append(str(error))
    if not jobs:
        raise ValueError(" ".join(failures))
    return DenoiseRun(jobs, failures, is_together=options is not None and options.together)
