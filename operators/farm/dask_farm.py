# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch by Dask: in processes of this computer, which Dask starts, or on the machines of a scheduler."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from .dispatch import Farm, FarmError

PATIENCE = 30
"""Seconds to wait for the scheduler."""

_PRELOAD = Path(__file__).with_name("worker_preload.py")


class NoDask(FarmError):
    """Dask is not installed."""


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
        # A process on a busy computer is slow to start again, and not lost.
        "distributed.deploy.lost-worker-timeout": "1h",
        "distributed.comm.timeouts.connect": "300s",
        "distributed.comm.timeouts.tcp": "300s",
        # Looks at the work a hundred times a second, for a page that nobody opens.
        "distributed.worker.profile.enabled": False,
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
    for name in ("distributed", "distributed.client", "tornado.application", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
