# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random sequences of what people do in Blender end in no traceback, and no mesh is other than it should be.

`FRAMELET_LIFE=300` tries as many sequences as it says; `make hunt-blender` does so.
"""

import contextlib
import io
import os
import threading
import warnings

import pytest
from blender_life.steps import live
from blender_life.world import World
from framelet.operators.run import denoise_run

N_SEQUENCES = int(os.environ.get("FRAMELET_LIFE", "30"))
N_STEPS = 25

pytestmark = pytest.mark.usefixtures("no_thread_stays")


@pytest.fixture
def gate(monkeypatch):
    """Holds the threads of runs until it is set, so that a sequence is the same each time."""
    opened, original = threading.Event(), denoise_run.compute

    def compute(job, callback=None, should_stop=None):
        while threading.current_thread() is not threading.main_thread() and not opened.wait(0.01):
            if should_stop():
                break
        return original(job, callback, should_stop)

    monkeypatch.setattr(denoise_run, "compute", compute)
    return opened


@pytest.mark.parametrize("seed", range(N_SEQUENCES))
def test_a_life(seed, gate, tmp_path):
    errors, world = io.StringIO(), World(seed, tmp_path)
    world.gate = gate
    try:
        # What handlers and timers raise is only printed.
        with contextlib.redirect_stderr(errors), warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            live(world, N_STEPS)
        printed = errors.getvalue()
        assert "Traceback" not in printed, printed
    except BaseException:
        print("\n".join(world.log))  # noqa: T201
        raise
