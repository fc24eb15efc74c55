# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise the mesh of one object in three steps: read, compute, write. No user interface.

Reading and writing belong to the main thread; `denoise_job.compute` between them may run on any.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..mesh_io.region_bridge import read_region
from ..mesh_io.shape_keys import read_followers
from ..properties.output_choices import IN_PLACE, SHAPE_KEY
from ..properties.region_options import RegionOptions
from ..properties.scene_units import linear_part
from . import run_memory
from .denoise_job import DenoiseJob, DenoiseOutcome, MeasuredReport, compute
from .output import refusal, write_output

if TYPE_CHECKING:
    import bpy

    from ...core.methods.problem import Callback
    from ...core.report import DenoiseReport
    from ...core.settings import DenoiseSettings


def read_job(
    obj: bpy.types.Object,
    settings: DenoiseSettings,
    output: str = IN_PLACE,
    options: RegionOptions | None = None,
) -> DenoiseJob:
    """Read what a run needs of an object.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode.
    settings : DenoiseSettings
        What will be done.
    output : str
        One of `output_choices.OUTPUTS`.
    options : RegionOptions, optional
        What limits the run; by default selection and hidden vertices alone.

    Raises
    ------
    ValueError
        With a sentence that names the object, if it cannot be edited or nothing may move.
    """
    reason = refusal(obj, output)
    if reason is not None:
        raise ValueError(reason)
    surface, movable, region = read_region(obj, options or RegionOptions())
    return DenoiseJob(obj.name, surface, settings, linear_part(obj), movable, region, output)


def write_outcome(obj: bpy.types.Object, job: DenoiseJob, outcome: DenoiseOutcome) -> bpy.types.Object:
    """Write what came of a job that was not stopped.

    Parameters
    ----------
    obj : bpy.types.Object
        The object, with the mesh as it was read.
    job : DenoiseJob
        What `read_job` returned.
    outcome : DenoiseOutcome
        What `denoise_job.compute` made of it.

    Returns
    -------
    bpy.types.Object
        The object that has the result: the same, or a new one.
    """
    followers = {} if job.output == SHAPE_KEY else read_followers(obj)
    written = write_output(obj, job.surface, outcome.vertices, job.output)
    run_memory.remember(written.obj, job.surface, written.positions, followers)
    return written.obj


class DenoisedObject(NamedTuple):
    """The object that has the result of a run, and the measured report."""

    obj: bpy.types.Object
    measured: MeasuredReport


def denoise_object(
    obj: bpy.types.Object,
    settings: DenoiseSettings,
    callback: Callback | None = None,
    output: str = IN_PLACE,
    options: RegionOptions | None = None,
) -> DenoiseReport:
    """Denoise the mesh of an object; in Edit Mode only the selected vertices.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in Object Mode or Edit Mode. Its active shape key is read; modifiers are not applied.
    settings : DenoiseSettings
        What to do.
    callback : callable, optional
        `callback(fraction, change)`, called after each iteration; returns True to stop.
    output : str
        Where the result goes, one of `output_choices.OUTPUTS`.
    options : RegionOptions, optional
        What limits the run to parts of the mesh, and how far vertices may move.

    Returns
    -------
    DenoiseReport
        Lengths are in object space. If the run was stopped, everything is as it was.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name. Everything is as it was.
    """
    return denoise_and_measure(obj, settings, callback, output, options).measured.report


def denoise_and_measure(
    obj: bpy.types.Object,
    settings: DenoiseSettings,
    callback: Callback | None = None,
    output: str = IN_PLACE,
    options: RegionOptions | None = None,
) -> DenoisedObject:
    """Denoise as `denoise_object` does, say which object has the result, and measure with its scale too."""
    job = read_job(obj, settings, output, options)
    outcome = compute(job, callback)
    if not outcome.measured.report.is_stopped:
        obj = write_outcome(obj, job, outcome)
    return DenoisedObject(obj, outcome.measured)
