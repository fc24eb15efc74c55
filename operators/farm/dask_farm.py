# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch by Dask: each task is one file, in a process of this computer or on the machines of a scheduler.

Dask starts the processes, hands out the files, and tries a file again whose process died. Arrays never cross
a border: workers read and write files, so that all machines must see the same folders. What crosses are plain
values and the name of a function, which the workers import from their own Framelet.
"""

from __future__ import annotations

import importlib
import logging
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from itertools import count, islice
from pathlib import Path
from time import monotonic, sleep
from typing import Any
from uuid import uuid4

from ...core.errors import FrameletError

PATIENCE = 30
"""Seconds to wait for the scheduler."""

DEATHS = 1
"""How many processes of this computer a file may take along and be tried again: it may not be to blame."""

ABANDONED = 300
"""Seconds without any worker after which a batch ends."""

_EVERY = 5.0
"""Seconds from one look at how many workers there are to the next."""

_NAP = 0.003
"""Seconds from one look for a result to the next."""

_PRELOAD = Path(__file__).with_name("worker_preload.py")
_PACKAGE = "framelet"


class FarmError(FrameletError):
    """Why there are no workers, or no longer, in one sentence for people."""


class NoDask(FarmError):
    """Dask is not installed."""


class Farm:
    """Workers of Dask, each a process with one thread.

    Parameters
    ----------
    client : distributed.Client
        Leads to them.
    """

    def __init__(self, client: Any) -> None:
        self._client = client

    def results(
        self, jobs: Iterable[dict[str, Any]], function: str
    ) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield each job with its row, as they end.

        A worker is given no second job before the row of the first is here: one that waits in a process that
        dies would count as dead with it, and a row that is left there would be lost.

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

        carry_out, waiting = _named(function), iter(jobs)
        # Keys of their own: what an earlier batch did on this scheduler is not what is asked for. And each in
        # a group of its own, of which Dask keeps none back.
        run, numbers = uuid4().hex, count()
        at_work: dict[Any, tuple[Any, dict[str, Any]]] = {}
        # With results, which are fetched meanwhile: one whose process died right after it is waited for here.
        ended = as_completed(loop=self._client.loop, with_results=True, raise_errors=False)

        def submit(n: int) -> None:
            for job in islice(waiting, max(n, 0)):
                key = (f"{_PACKAGE}-{run}-{next(numbers)}", 0)
                future = self._client.submit(carry_out, job, key=key, pure=False)
                at_work[key] = future, job
                ended.add(future)

        look = _Look(self._client)
        try:
            submit(look.n_workers)
            while at_work:
                if not ended.has_ready():
                    sleep(_NAP)
                    if look.again():
                        submit(look.n_workers - len(at_work))
                    continue
                future, result = next(ended)
                _future, job = at_work.pop(future.key)
                row = _row(future, result, job)
                submit(look.n_workers - len(at_work))
                yield job, row
        finally:
            self._client.cancel([future for future, _job in at_work.values()])


class _Look:
    """How many workers there are, looked at again and again: on machines of others this changes."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self.n_workers, self._last, self._last_seen = 1, -_EVERY, monotonic()
        self.again()

    def again(self) -> bool:
        """Look, if it is time; return whether it was.

        Raises
        ------
        FarmError
            If a worker would work on several files in one process, or there was none for long.
        """
        now = monotonic()
        if now - self._last < _EVERY:
            return False
        workers = self._client.nthreads()
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
        self.n_workers, self._last = max(len(workers), 1), now
        return True


def _row(future: Any, result: Any, job: dict[str, Any]) -> dict[str, Any]:
    """Return what came of a job."""
    from distributed import KilledWorker

    if future.status == "finished":
        return result
    if future.status != "error":
        raise FarmError("The scheduler was lost; start it and give the same command again, which goes on.")
    error = future.exception()
    if isinstance(error, KilledWorker):
        times = error.allowed_failures + 1
        return {
            "error": f"The process that worked on {job['source']} died, {times} times; the file may be "
            "damaged, or need more memory than there is."
        }
    reason = " ".join(f"{type(error).__name__}: {error}".split())
    if isinstance(error, ImportError) or "deserializ" in reason:
        raise FarmError(
            f"The workers have no Framelet, or another one ({reason}); install the same on all machines and "
            "on that of the scheduler."
        )
    return {"error": f"{job['source']} could not be worked on: {reason}."}


@contextmanager
def on_this_computer(n_processes: int, environment: dict[str, str]) -> Iterator[Farm]:
    """Start processes on this computer, each for one file at a time; they end with the context.

    Parameters
    ----------
    n_processes : int
        How many.
    environment : dict
        Environment variables of the processes.

    Raises
    ------
    NoDask
        If Dask is not installed.
    """
    try:
        import dask
        from distributed import Client, LocalCluster, Security

        # Whoever can reach a scheduler can run what he likes; on a shared machine that is everyone.
        security = Security.temporary()
    except ImportError as error:
        raise NoDask(f"There is no {error.name}; run 'pip install distributed cryptography'.") from error
    # Dask's own words on workers that die are told as rows.
    _silence()
    settings = {
        "distributed.scheduler.allowed-failures": DEATHS,
        # A process on a busy computer is slow to start again, and not lost.
        "distributed.deploy.lost-worker-timeout": "1h",
        "distributed.comm.timeouts.connect": "300s",
        "distributed.comm.timeouts.tcp": "300s",
    }
    with ExitStack() as stack:
        try:
            stack.enter_context(dask.config.set(settings))
            cluster = stack.enter_context(
                LocalCluster(
                    n_workers=n_processes,
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    dashboard_address=None,
                    # On a port that is free, or Dask would warn of another run.
                    scheduler_kwargs={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
                    security=security,
                    silence_logs=logging.CRITICAL,
                    # How much a file takes is estimated before the work; a share for each is no limit.
                    memory_limit=None,
                    preload=[f"import runpy; runpy.run_path({str(_PRELOAD)!r}, run_name='__main__')"],
                    env=environment,
                )
            )
            client = stack.enter_context(Client(cluster, set_as_default=False))
        except (OSError, RuntimeError) as error:
            raise FarmError(f"Dask cannot start processes here ({error}); leave out --jobs.") from error
        yield Farm(client)


@contextmanager
def of_scheduler(address: str) -> Iterator[Farm]:
    """Use the machines of a scheduler.

    Parameters
    ----------
    address : str
        Its address, as ``tcp://head:8786``.

    Raises
    ------
    NoDask
        If Dask is not installed.
    FarmError
        If the scheduler does not answer, or a worker would work on several files in one process.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise NoDask("--scheduler needs Dask; run 'pip install distributed cryptography'.") from error
    _silence()
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise FarmError(f"The scheduler {address} does not answer; start it, or mend the address.") from error
    with client:
        yield Farm(client)


def _silence() -> None:
    """Keep Dask's log off the terminal."""
    for name in ("distributed", "tornado.application", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)


def _named(function: str) -> Callable[[dict[str, Any]], dict[str, Any]]:
    """Return a function under the name by which workers import it, also where this package has another one.

    As an extension of Blender it has.
    """
    own = __name__.removesuffix(".operators.farm.dask_farm")
    sys.modules.setdefault(_PACKAGE, sys.modules[own])
    module, _colon, name = function.partition(":")
    return getattr(importlib.import_module(f"{_PACKAGE}.{module}"), name)
