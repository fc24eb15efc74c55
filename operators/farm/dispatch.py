# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files are given to workers of Dask, and tried again if their process dies.

Dask carries jobs and rows; which worker gets which file is decided here. Left to itself, Dask lets jobs wait
in a process, and counts its death against each of them; a file is to blame only if it was begun there.
Arrays never cross a border: workers read and write files, so that all machines must see the same folders.
What crosses are plain values and the name of a function, which the workers import from their own Framelet.
"""

from __future__ import annotations

import importlib
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from itertools import count
from time import monotonic, sleep
from typing import Any
from uuid import uuid4

from ...core.errors import FrameletError

TRIES = 2
"""How many processes a file may take along: the first may have died of something else."""

LOSSES = 4
"""How many processes may be lost before they began a file that they were given: this is not its fault."""

ABANDONED = 300
"""Seconds without any worker after which a batch ends."""

_EVERY = 1.0
"""Seconds from one look at which workers there are to the next."""

_NAP = 0.003
"""Seconds from one look for a result to the next."""

_PACKAGE = "framelet"
_HERE = "operators.farm.dispatch"


class FarmError(FrameletError):
    """Why there are no workers, or no longer, in one sentence for people."""


@dataclass
class _Dispatched:
    """A job, and what became of the processes that it was given to."""

    job: dict[str, Any]
    future: Any = None
    worker: str = ""
    n_deaths: int = 0
    n_losses: int = 0


class Farm:
    """Workers of Dask, each a process with one thread.

    Parameters
    ----------
    client : distributed.Client
        Leads to them.
    """

    def __init__(self, client: Any) -> None:
        self.client = client

    def results(
        self, jobs: Iterable[dict[str, Any]], function: str
    ) -> Generator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield each job with its row, as they end; to be closed before the farm is.

        Each worker is given one job at a time, which no other worker takes from it, and the next one when the
        row is here: a row that is left in a process that dies would be lost.

        Parameters
        ----------
        jobs : iterable of dict
            What the function is given; ``source`` names the file.
        function : str
            Name below the package, as ``operators.room.module:function``. It returns a row.

        Yields
        ------
        job, row : dict
            The row of a job that killed its processes has only ``error``.

        Raises
        ------
        FarmError
            If the scheduler is lost, or workers have no Framelet.
        """
        from distributed import as_completed

        # Keys of their own: what an earlier batch did on this scheduler is not what is asked for. And each in
        # a group of its own, of which Dask keeps none back.
        run, numbers = f"{_PACKAGE}-{uuid4().hex}", count()
        waiting = deque(_Dispatched(job) for job in jobs)
        at_work: dict[Any, _Dispatched] = {}
        begun: set[str] = set()
        # With results, which are fetched meanwhile.
        ended = as_completed(loop=self.client.loop, with_results=True, raise_errors=False)
        self.client.subscribe_topic(run, lambda event: begun.add(event[1]))
        workers = _Workers(self.client)

        def dispatch() -> None:
            for worker in workers.addresses - {each.worker for each in at_work.values()}:
                if not waiting:
                    break
                each, name = waiting.popleft(), f"{run}-{next(numbers)}"
                each.worker, each.future = worker, self.client.submit(
                    _named(f"{_HERE}:begin"), function, each.job, run, name,
                    key=(name, 0), workers=[worker], allow_other_workers=False, pure=False,
                )  # fmt: skip
                at_work[each.future.key] = each
                ended.add(each.future)

        def lost(each: _Dispatched) -> dict[str, Any] | None:
            """Put a job back whose process is gone; or return its row, if it has had its tries."""
            key = each.future.key
            del at_work[key]
            self.client.cancel([each.future])
            each.n_deaths += key[0] in begun
            each.n_losses += key[0] not in begun
            if each.n_deaths == TRIES or each.n_losses == LOSSES:
                return _row_of_dead(each)
            # At the end, when others are not held up by it.
            waiting.append(each)
            return None

        try:
            dispatch()
            while at_work or waiting:
                if not ended.has_ready():
                    sleep(_NAP)
                    if workers.looked_again():
                        for each in list(at_work.values()):
                            if each.worker not in workers.addresses and (row := lost(each)):
                                yield each.job, row
                        dispatch()
                    continue
                future, result = next(ended)
                if future.key not in at_work:
                    continue  # of a process that was given up
                each = at_work[future.key]
                row = lost(each) if _is_killed(future) else _row(future, result, each.job)
                at_work.pop(future.key, None)
                dispatch()
                if row is not None:
                    yield each.job, row
        finally:
            self.client.cancel([each.future for each in at_work.values()])
            self.client.unsubscribe_topic(run)


def begin(function: str, job: dict[str, Any], topic: str, name: str) -> dict[str, Any]:
    """Carry out a job in a worker, and say before that it is begun there.

    Parameters
    ----------
    function : str
        As `Farm.results` takes it.
    job : dict
        What it is given.
    topic, name : str
        Where this is said, and what the job is called there.

    Returns
    -------
    dict
        What the function returns.
    """
    from distributed import get_worker

    get_worker().log_event(topic, name)
    return _named(function)(job)


class _Workers:
    """Addresses of the workers, looked at again and again: they die, and machines of others come and go."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self.addresses: set[str] = set()
        self._last, self._last_seen = -_EVERY, monotonic()
        self.looked_again()

    def looked_again(self) -> bool:
        """Look, if it is time; return whether it was.

        Raises
        ------
        FarmError
            If a worker would work on several files in one process, or there was none for long, or the
            scheduler is lost.
        """
        now = monotonic()
        if now - self._last < _EVERY:
            return False
        try:
            workers = self._client.nthreads()
        except (OSError, TimeoutError) as error:
            raise FarmError(_LOST) from error
        for worker, n_threads in workers.items():
            if n_threads != 1:
                raise FarmError(
                    f"The worker {worker} has {n_threads} threads, and each file needs a process of its own; "
                    f"start it with --nworkers {n_threads} --nthreads 1."
                )
        if workers:
            self._last_seen = now
        elif now - self._last_seen > ABANDONED:
            raise FarmError(
                f"There was no worker for {ABANDONED} seconds; start one and give the same command again, "
                "which goes on."
            )
        self.addresses, self._last = set(workers), now
        return True


_LOST = "The scheduler was lost; start it and give the same command again, which goes on."


def _is_killed(future: Any) -> bool:
    """Return whether the scheduler gave a job up, as its process died."""
    from distributed import KilledWorker

    return future.status == "error" and isinstance(future.exception(), KilledWorker)


def _row_of_dead(each: _Dispatched) -> dict[str, Any]:
    source = each.job["source"]
    if each.n_deaths == TRIES:
        return {
            "error": f"The process that worked on {source} died, {TRIES} times; the file may be damaged, or "
            "need more memory than there is."
        }
    return {
        "error": f"{LOSSES} processes that {source} was handed to died before they began it; see what the "
        "workers of Dask say."
    }


def _row(future: Any, result: Any, job: dict[str, Any]) -> dict[str, Any]:
    """Return what came of a job."""
    if future.status == "finished":
        return result
    if future.status != "error":
        raise FarmError(_LOST)
    error = future.exception()
    reason = " ".join(f"{type(error).__name__}: {error}".split())
    if isinstance(error, ImportError) or "deserializ" in reason:
        raise FarmError(
            f"The workers have no Framelet, or another one ({reason}); install the same on all machines and "
            "on that of the scheduler."
        )
    return {"error": f"{job['source']} could not be worked on: {reason}."}


def _named(function: str) -> Callable[[dict[str, Any]], dict[str, Any]]:
    """Return a function under the name by which workers import it, also where this package has another one.

    As an extension of Blender it has.
    """
    own = __name__.removesuffix(f".{_HERE}")
    sys.modules.setdefault(_PACKAGE, sys.modules[own])
    module, _colon, name = function.partition(":")
    return getattr(importlib.import_module(f"{_PACKAGE}.{module}"), name)
