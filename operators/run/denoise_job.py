# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run needs of an object, as plain arrays, and the run itself.

Nothing here knows Blender, so that any thread may run it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from ..machine import available_bytes
from ..properties.scene_units import displacement_by, length_by
from .preparations import borrowed_preparations

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from ...core import Region, SurfaceMesh
    from ...core.methods.problem import Callback
    from ...core.report import DenoiseReport, DenoiseResult
    from ...core.settings import DenoiseSettings
    from ..modifier.arrays import Step
    from ..modifier.mirrors import Plane


@dataclass(frozen=True, eq=False)
class DenoiseJob:
    """The mesh of one object and what to do with it; `denoise_object.read_job` makes it.

    Attributes
    ----------
    name : str
        The object's name, for sentences.
    surface : SurfaceMesh
        Copies of the arrays of the mesh, positions in object space.
    settings : DenoiseSettings
        What to do.
    linear : ndarray, shape (3, 3), float64
        Rotation and scale of the object, for lengths in scene units.
    movable : ndarray of bool, shape (N,), or None
        Vertices that may move; None for all.
    region : Region or None
        What else limits the run.
    output : str
        One of `output_choices.OUTPUTS`, where the result goes.
    amount : float
        How much of what is moved is written.
    present : SurfaceMesh or None
        The mesh as it was read, if that was the result of a run, of which `surface` is the original.
    mirrors : tuple of Plane
        Planes in which modifiers mirror the mesh.
    steps : tuple of Step
        Steps by which modifiers repeat the mesh, with the vertices that they join.
    origin : ndarray, shape (3,), float64, or None
        Where the object is in the scene.
    cage : SurfaceMesh or None
        The mesh itself, if `surface` has what a modifier adds to it at the vertices that may not move.
    is_level : bool
        Whether `surface` is the finest level of a Multires modifier, and not the mesh.
    """

    name: str
    surface: SurfaceMesh
    settings: DenoiseSettings
    linear: NDArray[np.float64]
    movable: NDArray[np.bool_] | None = None
    region: Region | None = None
    output: str = "IN_PLACE"
    amount: float = 1.0
    present: SurfaceMesh | None = None
    mirrors: tuple[Plane, ...] = ()
    steps: tuple[Step, ...] = ()
    origin: NDArray[np.float64] | None = None
    cage: SurfaceMesh | None = None
    is_level: bool = False

    @property
    def base(self) -> SurfaceMesh:
        """The mesh to which the result is written."""
        return self.surface if self.cage is None else self.cage

    @property
    def read(self) -> SurfaceMesh:
        """The mesh as it was read."""
        return self.base if self.present is None else self.present


class MeasuredReport(NamedTuple):
    """A report, whose lengths are in object space, and how far vertices moved in scene units."""

    report: DenoiseReport
    scene_rms: float
    scene_max: float
    scale: float = 1.0
    """Scene units for a length of 1, of no particular direction, in object space."""


class DenoiseOutcome(NamedTuple):
    """What came of a job: positions in object space, shape (N, 3), and the measured report."""

    vertices: NDArray[np.floating]
    measured: MeasuredReport


def with_amount(measured: MeasuredReport, amount: float) -> MeasuredReport:
    """Return a report with the lengths of a part of the motion."""
    if amount == 1.0:
        return measured
    report = replace(
        measured.report,
        n_moved=measured.report.n_moved if amount else 0,
        displacement_rms=amount * measured.report.displacement_rms,
        displacement_max=amount * measured.report.displacement_max,
    )
    return measured._replace(
        report=report, scene_rms=amount * measured.scene_rms, scene_max=amount * measured.scene_max
    )


def compute(
    job: DenoiseJob,
    callback: Callback | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> DenoiseOutcome:
    """Carry out a job. Reads and writes nothing of Blender.

    Parameters
    ----------
    job : DenoiseJob
        What to do; its arrays are not changed, and must not be changed afterwards.
    callback : callable, optional
        `callback(fraction, change)`, called after each iteration; returns True to stop.
    should_stop : callable, optional
        Asked many times, also between iterations; returns True to stop.

    Returns
    -------
    DenoiseOutcome
        If it was stopped, the report says so and the positions are of no use.

    Raises
    ------
    ValueError
        With a sentence that begins with the object's name.
    """
    from ...core import denoise

    with borrowed_preparations(should_stop) as cache:
        try:
            result = denoise(
                job.surface,
                job.settings,
                movable=job.movable,
                region=job.region,
                callback=callback,
                should_stop=should_stop,
                prepared=cache,
                max_bytes=available_bytes(),
            )
        except ValueError as error:
            raise ValueError(f"‘{job.name}’: {error}") from error
    return DenoiseOutcome(result.vertices, _measured(job, result))


def _measured(job: DenoiseJob, result: DenoiseResult) -> MeasuredReport:
    """Return the report of a job with lengths in scene units."""
    import numpy as np

    report = result.report
    if np.array_equal(job.linear, np.eye(3)):
        rms, maximum = report.displacement_rms, report.displacement_max
    else:
        rms, maximum = displacement_by(
            job.linear, job.surface.vertices, result.vertices, job.settings.threads
        )
    return MeasuredReport(report, rms, maximum, length_by(job.linear, 1.0))
