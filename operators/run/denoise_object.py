# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise the mesh of one object in three steps: read, compute, write. No user interface.

Reading and writing belong to the main thread; `denoise_job.compute` between them may run on any.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from ...core.value_checks import check_number
from ..mesh_io import custom_normals
from ..mesh_io.region_bridge import read_region
from ..mesh_io.shape_keys import read_followers
from ..modifier.arrays import read_steps, read_weld_distance
from ..modifier.displacement import stored_displacement
from ..modifier.inputs import get_input
from ..modifier.mirrors import read_mirrors
from ..modifier.multires import find_multires, level_object
from ..modifier.node_groups import ON
from ..modifier.offsets import offset_of
from ..modifier.recipes import DISPLACEMENT
from ..modifier.stack import find_modifier
from ..properties.output_choices import IN_PLACE, MODIFIER, SHAPE_KEY
from ..properties.region_options import RegionOptions
from ..properties.scene_units import linear_part, origin_of
from . import run_memory
from .assembly import assemble
from .denoise_job import DenoiseJob, DenoiseOutcome, MeasuredReport, compute
from .output import WrittenOutput, refusal, write_level, write_output

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
    *,
    amount: float = 1.0,
    from_original: bool | None = None,
) -> DenoiseJob:
    """Read what a run needs of an object.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object in one of `mesh_bridge.MODES`.
    settings : DenoiseSettings
        What will be done.
    output : str
        One of `output_choices.OUTPUTS`; in Sculpt Mode a modifier would not be seen, so that the mesh is
        changed in place.
    options : RegionOptions, optional
        What limits the run; by default selection and hidden vertices alone.
    amount : float
        How much of what is moved is written.
    from_original : bool or None
        True starts from where the vertices were before the last run, if the mesh still is what that made;
        False from its result, also from one in a modifier; None from the mesh itself.

    Raises
    ------
    ValueError
        With a sentence that names the object, if it cannot be edited or nothing may move.
    """
    check_number("Amount", amount, 0.0, 2.0)
    if obj.mode == "SCULPT" and output == MODIFIER:
        output = IN_PLACE  # Blender shows no modifier of this kind there, and brushes change the mesh itself
    reason = refusal(obj, output)
    if reason is not None:
        raise ValueError(reason)
    if find_multires(obj) is not None:
        return _read_level(obj, settings, output, options or RegionOptions(), amount)
    surface, movable, region = read_region(obj, options or RegionOptions())
    joined = read_weld_distance(obj)
    if joined is not None and region.weld_distance is not None:
        region = replace(region, weld_distance=max(joined, region.weld_distance))
    job = DenoiseJob(
        obj.name,
        surface,
        settings,
        linear_part(obj),
        movable,
        region,
        output,
        amount,
        mirrors=read_mirrors(obj),
        steps=read_steps(obj, surface),
        origin=origin_of(obj),
    )
    job = _with_modifier(obj, job, from_original)
    run = run_memory.last_run_of(obj, surface) if from_original else None
    if run is None:
        return job
    original = surface.with_vertices(run.before)
    if region.max_displacement is not None and options is not None and options.limit == "EDGES":
        from ...core.mesh.geometry import mean_edge_length

        region = replace(region, max_displacement=options.max_edges * mean_edge_length(original))
    return replace(job, surface=original, region=region, present=surface)


def _read_level(
    obj: bpy.types.Object, settings: DenoiseSettings, output: str, options: RegionOptions, amount: float
) -> DenoiseJob:
    """Read what a run needs of the finest level of Multires."""
    with level_object(obj) as level:
        try:
            surface, movable, region = read_region(level, options)
        except ValueError as error:
            raise ValueError(str(error).replace(f"‘{level.name}’", f"‘{obj.name}’")) from error
    return DenoiseJob(
        obj.name,
        surface,
        settings,
        linear_part(obj),
        movable,
        region,
        output,
        amount,
        origin=origin_of(obj),
        is_level=True,
    )


def _with_modifier(obj: bpy.types.Object, job: DenoiseJob, from_original: bool | None) -> DenoiseJob:
    """Add what the modifier of a run before adds, where this run does not start from the mesh itself.

    That is where it may not move vertices, so that parts of a mesh can be denoised one after the other; and
    all over where it continues from the result. A modifier that is off shows no result.
    """
    import numpy as np

    modifier = find_modifier(obj, DISPLACEMENT)
    if modifier is None:
        return job
    stays = None if job.movable is None else ~job.movable
    if job.region is not None and job.region.weights is not None:
        still = job.region.weights == 0.0
        stays = still if stays is None else stays | still
    if from_original is False and get_input(modifier, ON):
        stays = np.ones(job.surface.n_vertices, bool)
    if stays is None:
        return job
    added = stored_displacement(obj) if job.output == MODIFIER else offset_of(obj, DISPLACEMENT)
    assert added is not None  # there is a modifier
    vertices = job.surface.vertices.copy()
    vertices[stays] += added[stays]
    return replace(job, surface=job.surface.with_vertices(vertices), cage=job.surface)


def write_outcome(obj: bpy.types.Object, job: DenoiseJob, outcome: DenoiseOutcome) -> WrittenOutput:
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
    WrittenOutput
        The object that has the result, the same or a new one, and what else was done.
    """
    output = job.output
    if job.is_level:
        return write_level(obj, job.surface, outcome.vertices, output, job.amount)
    if job.present is not None:
        output = run_memory.go_back(obj, output)
    followers = {} if output in {SHAPE_KEY, MODIFIER} else read_followers(obj)
    normals = custom_normals.read_normals(obj.data)
    written = write_output(obj, job.base, outcome.vertices, output, job.amount)
    run_memory.remember(
        written.obj, job.base, written.positions, followers, output=job.output, normals=normals
    )
    return written


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
    assembly = assemble([job])
    (outcome,) = assembly.split(compute(assembly.job, callback))
    if not outcome.measured.report.is_stopped:
        obj = write_outcome(obj, job, outcome).obj
    return DenoisedObject(obj, outcome.measured)
