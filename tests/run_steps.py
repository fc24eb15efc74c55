# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs and previews on their threads, step by step, as Blender's timers would do it."""

import threading

import bpy
from framelet.core import PRESETS, denoise
from framelet.operators.mesh_io import kept_original
from framelet.operators.preview import current_preview
from framelet.operators.properties.setting_values import to_settings
from framelet.operators.run import current_run
from framelet.operators.run.denoise_run import begin_run

QUICK = PRESETS["POSITIONS"].settings
SECONDS = 60
"""How long a thread may take."""


def framelet_threads():
    return [thread for thread in threading.enumerate() if thread.name.startswith("framelet")]


def start(*objects, settings=QUICK, output="IN_PLACE"):
    """Start a run as the panel does."""
    run = begin_run(objects, settings, output)
    current_run.set_current(run)
    run.start()
    return run


def until_done(run):
    """Tick as the modal operator does, once the thread has ended."""
    assert run.wait(SECONDS)
    return run.tick()


def turn_on():
    """Turn the preview of the active object on, and return its session."""
    assert bpy.ops.object.framelet_preview() == {"FINISHED"}
    session = current_preview.current_preview()
    assert session is not None
    return session


def settle(session):
    """Tick as the timer does until all that was asked for is shown."""
    current_preview.tick_preview()
    assert session.wait(SECONDS)
    current_preview.tick_preview()


def expected_for(surface, settings):
    """Return what a preview with the scene's settings has to show."""
    return denoise(surface, to_settings(settings)).vertices


def assert_clean(mesh):
    """No trace of a preview is left."""
    assert not any(name in mesh.attributes for name in kept_original.NAMES) and not mesh.keys()


def same(first, second):
    """Return whether two arrays are equal to the last bit."""
    return first.tobytes() == second.tobytes()
