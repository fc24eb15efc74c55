# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one run that may be going on, for all that has to know of it: operators, panels and handlers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bpy.app.translations import pgettext_n as n_

if TYPE_CHECKING:
    from .denoise_run import DenoiseRun

IS_RUNNING = n_("Framelet is running; press Esc in the 3D View to cancel")

_run: DenoiseRun | None = None

_ending: list[DenoiseRun] = []
"""Canceled runs whose threads have not noticed yet."""


def current_run() -> DenoiseRun | None:
    """Return the run that is going on, or None."""
    global _run
    if _run is not None and not _run.is_active:
        _ending.append(_run)
        _run = None
    if _ending:
        _ending[:] = [ended for ended in _ending if not ended.wait(0.0)]
    return _run


def set_current(run: DenoiseRun) -> None:
    """Make a run the current one.

    Raises
    ------
    ValueError
        In one sentence, if another one is going on.
    """
    global _run
    if current_run() is not None:
        raise ValueError(f"{IS_RUNNING}.")
    _run = run


def drop_current(change: str) -> None:
    """Give up the run that is going on, if there is one, because of what happened."""
    run = current_run()
    if run is not None:
        run.drop(change)


def touch_current(touched: set[int]) -> None:
    """Tell the run that is going on, if there is one, the session numbers of what was updated."""
    run = current_run()
    if run is not None:
        run.touch(touched)


def stop_current() -> None:
    """Cancel the run that is going on, and wait until its thread and those of canceled ones have ended."""
    run = current_run()
    if run is not None:
        run.cancel()
        current_run()
    while _ending:
        _ending.pop().wait()
