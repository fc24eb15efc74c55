# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds of stages and peak memory of this process."""

import sys
from pathlib import Path
from time import perf_counter


class Stopwatch:
    """Adds up seconds by the name of a stage."""

    def __init__(self):
        self.seconds = {}

    def wrap(self, module, name, stage):
        """Time all calls of a function of a module from now on."""
        setattr(module, name, self.timed(getattr(module, name), stage))

    def timed(self, function, stage):
        """Return a function that times itself."""

        def timed(*given, **named):
            began = perf_counter()
            try:
                return function(*given, **named)
            finally:
                self.add(stage, perf_counter() - began)

        return timed

    def add(self, stage, seconds):
        self.seconds[stage] = self.seconds.get(stage, 0.0) + seconds

    def run(self, stage, function):
        """Call a function and count its time to a stage."""
        began = perf_counter()
        result = function()
        self.add(stage, perf_counter() - began)
        return result


def begin_peak():
    """Forget the peak so far where the system lets us, and return what the process holds, in bytes.

    Elsewhere it is the peak so far, so that less may be counted than was needed.
    """
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
        return _held("VmRSS")
    except OSError:
        return peak_bytes()


def peak_bytes():
    """Return the most memory that this process held, since `begin_peak` if possible; 0 if it is not known."""
    try:
        return _held("VmHWM")
    except OSError:
        pass
    try:
        import resource
    except ImportError:
        return 0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def _held(name):
    """Return an entry of what Linux says of this process, in bytes."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(name + ":"):
            return 1024 * int(line.split()[1])
    raise OSError(name)


def triad_seconds(n_bytes):
    """Return the seconds of a plain numpy triad a = b + s c, whose three arrays have so many bytes in all.

    Best of five on one thread, into memory that is there already: the floor of what moves as many bytes.
    """
    import numpy as np

    n = max(1, n_bytes // 12)
    a, b, c = (np.ones(n, np.float32) for _ in range(3))
    best = float("inf")
    for _ in range(5):
        began = perf_counter()
        np.multiply(c, np.float32(3.0), out=a)
        np.add(a, b, out=a)
        best = min(best, perf_counter() - began)
    return best
