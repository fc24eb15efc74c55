# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise the mesh of one object in three steps: read, compute, write. No user interface.

Reading and writing belong to the main thread; `denoise_job.compute` between them may run on any.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import mesh_bridge, run_memory
from .denoise_job import DenoiseJob, DenoiseOutcome, MeasuredReport, compute
from .scene_units import linear_part

if TYPE_CHECKING:
    import bpy

    from ..core.denoising.report import Callback, DenoiseReport
    from ..core.settings import DenoiseSettings


def read_job(obj: bpy.types.Object, settings: DenoiseSettings) -> DenoiseJob:
    """Read what a run needs of an object.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode.
    settings : DenoiseSettings
        What will be done.

    Raises
    ------
    ValueError
        With a sentence that names the object, if it cannot be edited or nothing is selected.
    """
    reason = mesh_bridge.refusal(obj)
    if reason is not None:
        raise ValueError(reason)
    surface, movable = mesh_bridge.read_surface_and_movable(obj)
    if movable is not None and not movable.any():
        raise ValueError(f"‘{obj.name}’ has no selected vertices; select what should be denoised.")
    return DenoiseJob(obj.name, surface, settings, linear_part(obj), movable)


def write_outcome(obj: bpy.types.Object, job: DenoiseJob, outcome: DenoiseOutcome) -> None:
    """Write what came of a job to the object that it was read from; a stopped run leaves it as it is.

    Parameters
    ----------
    obj : bpy.types.Object
        The object, with the mesh as it was read.
    job : DenoiseJob
        What `read_job` returned.
    outcome : DenoiseOutcome
        What `denoise_job.compute` made of it.
    """
    if not outcome.measured.report.is_stopped:
        run_memory.write_and_remember(obj, job.surface, outcome.vertices)


def denoise_object(
    obj: bpy.types.Object, settings: DenoiseSettings, callback: Callback | None = None
) -> DenoiseReport:
    """Denoise the mesh of an object in place; in Edit Mode only the selected vertices.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode. Its active shape key is edited; modifiers are not applied.
    settings : DenoiseSettings
        What to do.
    callback : callable, optional
        `callback(fraction, change)`, called after each iteration; returns True to stop.

    Returns
    -------
    DenoiseReport
        Lengths are in object space. If the run was stopped, the mesh is as it was.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name. The mesh is as it was.
    """
    return denoise_and_measure(obj, settings, callback).report


def denoise_and_measure(
    obj: bpy.types.Object, settings: DenoiseSettings, callback: Callback | None = None
) -> MeasuredReport:
    """Denoise as `denoise_object` does, and measure with the object's scale too."""
    job = read_job(obj, settings)
    outcome = compute(job, callback)
    write_outcome(obj, job, outcome)
    return outcome.measured
