# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on the machines of a Dask scheduler: each task is one file, and rows come back as they end.

Arrays never cross the network: workers read and write files, so that all machines must see the same folders.
What crosses are plain values and the name of a function, which the workers import from their own Framelet.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any
from uuid import uuid4

from ..batch.inputs import PlanError
from ..batch.workers import THREADS, Seat

PATIENCE = 30
"""Seconds to wait for the scheduler."""

_seats = threading.local()


@contextmanager
def results(
    jobs: Sequence[dict[str, Any]], scheduler: str
) -> Iterator[Iterator[tuple[dict[str, Any], dict[str, Any]]]]:
    """Give each job with its row, as they end; jobs that have not ended are cancelled on leaving.

    Parameters
    ----------
    jobs : sequence of dict
        As `Seat.carry_out` takes them.
    scheduler : str
        Its address.

    Raises
    ------
    PlanError
        If Dask is not installed, or the scheduler does not answer.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise PlanError("--scheduler needs Dask; install it with 'pip install framelet[farm]'.") from error
    try:
        client = Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise PlanError(
            f"The scheduler {scheduler} does not answer; start it, or mend the address."
        ) from error
    with client:
        # Keys of their own: what an earlier batch did on this scheduler is not what is asked for.
        run = uuid4().hex
        by_key = {f"framelet-{run}-{number}": job for number, job in enumerate(jobs)}
        futures = [client.submit(carry_out, job, key=key, pure=False) for key, job in by_key.items()]
        try:
            yield _as_they_end(client, futures, by_key)
        finally:
            client.cancel(futures)


def _as_they_end(
    client: Any, futures: list[Any], by_key: dict[str, dict[str, Any]]
) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    from distributed import as_completed

    for future in as_completed(futures, loop=client.loop):
        job = by_key[future.key]
        if future.status == "finished":
            yield job, future.result()
        else:
            # A machine that is lost is no error: Dask gives its files to others, and ends up here only where
            # several were lost with one file.
            reason = " ".join(str(future.exception()).split())
            yield job, {"error": f"{job['source']} could not be worked on by any machine: {reason}"}
        future.release()


def carry_out(job: dict[str, Any]) -> dict[str, Any]:
    """Carry out a job on a worker of Dask, in a process that stays for the next one.

    A thread of a worker has a process with one thread: ``dask worker --nthreads`` says how many files are
    worked on at a time.
    """
    seat = getattr(_seats, "seat", None)
    if seat is None:
        seat = _seats.seat = Seat({THREADS: "1"})
    return seat.carry_out(job)
