# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes that work on one file after another; one that dies takes the file it has along, and no other."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

MARK = "\x1eframelet-row "
"""Begins each line that is a row; libraries print other lines."""

SCRIPT = Path(__file__).with_name("worker_script.py")

THREADS = "FRAMELET_THREADS"
"""The environment variable that says how many threads a process may use."""

ATTEMPTS = 2
"""How often a file is tried that takes its process along: what killed it may have been another program."""


class WorkerDied(Exception):
    """How a process ended that should have gone on."""


class Worker:
    """A process that takes a job a line and answers with a row a line.

    Parameters
    ----------
    command : sequence of str
        How it is started. It ends when its input ends.
    environment : dict
        Environment variables besides those of this process.
    """

    def __init__(self, command: Sequence[str], environment: dict[str, str]) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - as long as the process
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=os.environ | environment,
            # Ctrl-C is for the process that waits; it ends the others.
            start_new_session=True,
        )

    def carry_out(self, job: dict[str, Any]) -> dict[str, Any]:
        """Return what came of a job.

        Raises
        ------
        WorkerDied
            If the process ended meanwhile.
        """
        process = self._process
        assert process.stdin is not None and process.stdout is not None
        with suppress(OSError):  # it is dead; how it ended is found below
            process.stdin.write(json.dumps(job).encode("ascii") + b"\n")
            process.stdin.flush()
        for line in process.stdout:
            text = line.decode("utf-8", "replace")
            if text.startswith(MARK):
                return json.loads(text[len(MARK) :])
        code = process.wait()
        how = f"was killed by {_signal_name(-code)}" if code < 0 else f"ended with exit code {code}"
        self._errors.seek(0)
        last = self._errors.read()[-2000:].decode("utf-8", "replace").strip().splitlines()[-1:]
        raise WorkerDied(how + (f" ({' '.join(last[0].split())})" if last and code > 0 else ""))

    def end(self) -> None:
        """Let the process end, or end it if it does not."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(2.0)
        self.kill()

    def kill(self) -> None:
        """End the process, and what it started."""
        with suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()
        self._process.wait()


class Seat:
    """A place for a process, which is filled again when it dies; the process stays from file to file.

    Parameters
    ----------
    environment : dict
        Environment variables of the process.
    command : sequence of str, optional
        How it is started; by default `worker_script.py` in this Python.
    """

    def __init__(self, environment: dict[str, str], command: Sequence[str] = ()) -> None:
        self._command = list(command) or [sys.executable, str(SCRIPT), str(os.getpid())]
        self._environment = environment
        self._lock = threading.Lock()
        self._worker: Worker | None = None
        self._is_closed = False

    def carry_out(self, job: dict[str, Any]) -> dict[str, Any]:
        """Return what came of a job.

        The row of a job that killed its process `ATTEMPTS` times has only `error` and `attempts`.
        """
        how = "was ended"
        for attempt in range(1, ATTEMPTS + 1):
            worker = self._filled()
            if worker is None:
                break
            try:
                return worker.carry_out(job) | {"attempts": attempt}
            except WorkerDied as error:
                how = str(error)
                self._empty(worker)
        sentence = (
            f"The process that worked on {job['source']} {how}, {ATTEMPTS} times; the file may be damaged."
        )
        return {"error": sentence, "attempts": ATTEMPTS}

    def _filled(self) -> Worker | None:
        """Return the process, started if there is none; None once the place is closed."""
        with self._lock:
            if self._worker is None and not self._is_closed:
                self._worker = Worker(self._command, self._environment)
            return self._worker

    def _empty(self, worker: Worker) -> None:
        with self._lock:
            if self._worker is worker:
                self._worker = None
        worker.kill()

    def leave(self) -> None:
        """Let the process end: there is nothing more to do."""
        with self._lock:
            worker, self._worker = self._worker, None
        if worker is not None:
            worker.end()

    def close(self) -> None:
        """End the process at once, and start no other."""
        with self._lock:
            self._is_closed = True
            worker = self._worker
        if worker is not None:
            worker.kill()


class Workers:
    """Some processes, and the files that are left; a context manager that ends the processes.

    Parameters
    ----------
    number : int
        How many processes there are.
    environment : dict
        Environment variables of the processes.
    command : sequence of str, optional
        How a process is started; see `Seat`.
    """

    def __init__(self, number: int, environment: dict[str, str], command: Sequence[str] = ()) -> None:
        self._seats = [Seat(environment, command) for _ in range(number)]
        self._lock = threading.Lock()
        self._is_over = False

    def run(self, jobs: Iterable[dict[str, Any]]) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield each job with its row, as they end; see `Seat.carry_out`."""
        results: queue.Queue[Any] = queue.Queue()
        waiting = iter(jobs)

        def serve(seat: Seat) -> None:
            try:
                while not self._is_over:
                    with self._lock:
                        job = next(waiting, None)
                    if job is None:
                        break
                    results.put((job, seat.carry_out(job)))
                seat.leave()
            except BaseException as error:
                results.put(error)
            finally:
                results.put(None)

        # The system ends a process with the thread that started it: each lasts as long as its process.
        threads = [threading.Thread(target=serve, args=(seat,), daemon=True) for seat in self._seats]
        for thread in threads:
            thread.start()
        running = len(threads)
        while running:
            result = results.get()
            if result is None:
                running -= 1
            elif isinstance(result, BaseException):
                raise result
            else:
                yield result

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over = True
        for seat in self._seats:
            seat.close()


def _signal_name(number: int) -> str:
    """Return the name of a signal."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
