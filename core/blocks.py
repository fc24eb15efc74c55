# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a kernel over blocks of vertices on threads.

A block's temporaries stay in the cache, and numpy releases the interpreter lock inside its loops, so that
threads scale. Block borders depend on the block size alone, never on the number of threads: results are the
same bits for any number of threads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from threading import Lock
from types import TracebackType
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .processors import default_threads
from .value_checks import check_number

Result = TypeVar("Result")

BLOCK_SIZE = 32768


class Stopped(Exception):
    """Raised between two blocks once a run is asked to stop."""


class Blocks:
    """Threads that run kernels over index ranges; a context manager, which may be entered again.

    Functions that take a parameter `blocks` do their work on it; without one, on the calling thread.

    Outside of `with`, kernels run on the calling thread.

    Parameters
    ----------
    n_threads : int
        Number of threads; 0 for as many as `processors` says.
    block_size : int
        Number of elements in a block.
    """

    def __init__(self, n_threads: int = 0, block_size: int = BLOCK_SIZE) -> None:
        check_number("The number of threads", n_threads, 0, is_whole=True)
        self.n_threads = n_threads or default_threads()
        self.block_size = block_size
        self._pool: ThreadPoolExecutor | None = None
        self._owner = self  # whose threads these are
        self._should_stop: Callable[[], bool] | None = None

    def __enter__(self) -> Blocks:
        if self.n_threads > 1:
            self._pool = ThreadPoolExecutor(self.n_threads - 1, thread_name_prefix="framelet")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None
        self._should_stop = None

    @contextmanager
    def entered(
        self, should_stop: Callable[[], bool] | None, n_threads: int | None = None
    ) -> Iterator[Blocks]:
        """Enter these blocks with a number of threads, by default that of before, and with a question.

        `should_stop` is asked before each block until they are left: True raises `Stopped`. It is asked on
        the thread that `run` was called on; kernels that call `run` themselves ask on theirs.
        """
        if n_threads is not None:
            self.n_threads = n_threads or default_threads()
        self._should_stop = should_stop
        with self:
            yield self

    def check(self) -> None:
        """Raise `Stopped` if the run is asked to stop; for long work that has no blocks."""
        should_stop = self._owner._should_stop
        if should_stop is not None and should_stop():
            raise Stopped

    def with_block_size(self, block_size: int) -> Blocks:
        """Return the same threads with another block size; they live and die with this object's."""
        other = Blocks(self.n_threads, block_size)
        other._owner = self._owner
        return other

    def run(self, kernel: Callable[[int, int], Result], n_items: int) -> list[Result]:
        """Call `kernel(start, stop)` for each block of `range(n_items)`.

        Returns
        -------
        list
            The kernel's results in the order of the blocks, whichever thread was first.

        Raises
        ------
        Stopped
            If the function given to `entered` says so. Kernels that have begun are waited for.
        """
        starts = range(0, n_items, self.block_size)
        results: list[Any] = [None] * len(starts)
        errors: dict[int, BaseException] = {}
        # Every thread, the calling one too, takes the next number when it is done with a block: to hand out
        # blocks one by one would cost as much as a small kernel.
        numbers, lock = iter(range(len(starts))), Lock()

        def take() -> int | None:
            with lock:  # an iterator is not safe to share where Python runs several threads at a time
                return None if errors else next(numbers, None)

        def work(*, asks: bool) -> int:
            n_taken = 0
            while (number := take()) is not None:
                n_taken += 1
                try:
                    if asks:
                        self.check()
                    start = starts[number]
                    results[number] = kernel(start, min(start + self.block_size, n_items))
                except BaseException as error:
                    errors[number] = error
            return n_taken

        pool = self._owner._pool
        n_helpers = 0 if pool is None else min(self._owner.n_threads, len(starts)) - 1
        helpers = []
        for _ in range(n_helpers):
            try:
                helpers.append(pool.submit(work, asks=False))  # type: ignore[union-attr]
            except RuntimeError:
                break  # where memory ends no thread starts; those that there are do the work
        n_taken = work(asks=True)
        for helper in helpers:
            if not helper.cancel():
                helper.result()
        if errors:
            raise errors[min(errors)]
        for _ in range(n_taken, len(starts)):
            self.check()  # once for each block, whoever took it
        return results

    def indices(self, is_wanted: Callable[[int, int], NDArray[np.bool_]], n_items: int) -> NDArray[np.intp]:
        """Return the indices below `n_items`, ascending, for which `is_wanted(start, stop)` is true."""
        parts = self.run(lambda start, stop: start + np.flatnonzero(is_wanted(start, stop)), n_items)
        return np.concatenate(parts) if parts else np.zeros(0, np.intp)

    def take(self, values: NDArray[Any], index: NDArray[np.integer]) -> NDArray[Any]:
        """Return `values[index]`, shape (n, ...), looked up on threads; the indices are trusted."""
        values = np.ascontiguousarray(values)
        result = np.empty((len(index), *values.shape[1:]), values.dtype)

        def kernel(start: int, stop: int) -> None:
            values.take(index[start:stop], axis=0, out=result[start:stop], mode="clip")

        self.run(kernel, len(index))
        return result

    def together(self, *tasks: Callable[[], Any]) -> list[Any]:
        """Call functions at the same time, as far as there are threads, and return what they return."""
        return self.with_block_size(1).run(lambda start, _: tasks[start](), len(tasks))
