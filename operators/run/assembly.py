# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is computed as one surface: an object with its mirrored halves, and objects whose borders meet.

Copies of the meshes are laid side by side, their borders are welded for the work, and each object takes the
motion of its own vertices. Vertices that an Array modifier joins take the mean of their motions: they stay
joined, without the work that copies on all sides would be.

Nothing here knows Blender, so that any thread may run it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from ..properties.scene_units import displacement_by, length_by
from .denoise_job import DenoiseJob, DenoiseOutcome, MeasuredReport

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from ...core import Region, SurfaceMesh
    from ...core.mesh.joined import Placement
    from ...core.report import DenoiseReport
    from ..modifier.arrays import Step
    from ..modifier.mirrors import Plane

NEAR = 1e-4
"""Borders that are at most so many mean edge lengths apart are taken for the same place: positions of
different objects and of mirrored halves differ by rounding."""

COUNTS = (
    "flipped_faces",
    "folded_faces",
    "folded_faces_before",
    "degenerate_faces",
    "degenerate_faces_before",
    "damped_vertices",
    "line_vertices",
    "irregular_vertices",
    "boundary_vertices",
    "non_manifold_vertices",
    "loose_vertices",
    "welded_vertices",
)
"""What a report counts over all copies."""


class Member(NamedTuple):
    """A job of an assembly: its first vertex there, the place of the first copy, and its vertices in planes.

    `seams` has, for each plane, its normal in the space of the object and the vertices in it.
    """

    job: DenoiseJob
    start: int
    linear: NDArray[np.float64]
    n_copies: int
    seams: list[tuple[NDArray[np.float64], NDArray[np.intp]]]


@dataclass(frozen=True, eq=False)
class Assembly:
    """One job instead of several; `assemble` makes it.

    Attributes
    ----------
    job : DenoiseJob
        What to compute.
    members : list of Member
        Whose results it has; none if the job is the only one, as it was given.
    """

    job: DenoiseJob
    members: list[Member]

    def split(self, outcome: DenoiseOutcome) -> list[DenoiseOutcome]:
        """Return what came of each of the jobs."""
        if not self.members or outcome.measured.report.is_stopped:
            return [outcome] * max(len(self.members), 1)
        import numpy as np

        found = []
        whole = self.job.surface.vertices
        n_copies = sum(member.n_copies * member.job.surface.n_vertices for member in self.members)
        share = sum(member.job.surface.n_vertices for member in self.members) / n_copies
        for number, (job, start, linear, _, seams) in enumerate(self.members):
            own = slice(start, start + job.surface.n_vertices)
            motion = (outcome.vertices[own] - whole[own]) @ np.linalg.inv(linear).T
            for _ in range(2):  # where seams of several kinds meet
                for normal, vertices in seams:
                    motion[vertices] -= np.outer(motion[vertices] @ normal, normal)
                for step in job.steps:
                    _join(motion, step)
            vertices = job.surface.vertices + motion
            report = outcome.measured.report
            counts = {name: round(share * getattr(report, name)) for name in COUNTS}
            counts = {name: count if number == 0 else 0 for name, count in counts.items()}
            seconds = report.seconds if number == 0 else 0.0
            report = replace(report, **counts, seconds=seconds)
            found.append(DenoiseOutcome(vertices, self._measured(job, report, vertices, motion)))
        return found

    def _measured(
        self,
        job: DenoiseJob,
        report: DenoiseReport,
        vertices: NDArray[np.floating],
        motion: NDArray[np.float64],
    ) -> MeasuredReport:
        """Return the report of one job, with the lengths of its own motion in the space of the assembly."""
        import numpy as np

        rms, largest = displacement_by(job.linear, job.surface.vertices, vertices, job.settings.threads)
        scale = length_by(self.job.linear, 1.0)
        report = replace(
            report,
            n_vertices=job.surface.n_vertices,
            n_faces=job.surface.n_faces,
            n_moved=int(np.count_nonzero(motion.any(axis=1))),
            displacement_rms=rms / scale if scale else 0.0,
            displacement_max=largest / scale if scale else 0.0,
        )
        return MeasuredReport(report, rms, largest, scale)


def assemble(jobs: Sequence[DenoiseJob]) -> Assembly:
    """Put jobs together that are to be computed as one surface.

    Parameters
    ----------
    jobs : sequence of DenoiseJob
        At least one. A single one without mirrors is left as it is; a single one with mirrors is computed in
        the space of its object, several are in that of the scene.
    """
    first = jobs[0]
    import numpy as np

    if len(jobs) == 1 and not first.mirrors:
        return Assembly(first, [Member(first, 0, np.eye(3), 1, [])] if first.steps else [])

    from ...core.mesh.borders import border_vertices
    from ...core.mesh.geometry import mean_edge_length
    from ...core.mesh.joined import joined

    placements: list[Placement] = []
    members, weldable = [], []
    for job in jobs:
        linear, origin = np.eye(3), np.zeros(3)
        if len(jobs) > 1:
            assert job.origin is not None  # `read_job` has set it
            linear, origin = job.linear, job.origin
            place = np.column_stack((linear, origin))
            if not np.isfinite(place).all() or np.linalg.matrix_rank(linear) < 3:
                raise ValueError(
                    f"‘{job.name}’ is flat by its scale, or at no place in the scene, so that it cannot be "
                    "denoised together with others; set its scale and location."
                )
        border = border_vertices(job.surface)
        surface, seams = _on_planes(job.surface, job.mirrors, border)
        start = sum(each.surface.n_vertices for each in placements)
        copies = _copies(surface, job.mirrors, seams, linear, origin)
        placements += copies
        members.append(Member(job, start, linear, len(copies), seams))
        mask = border if len(jobs) > 1 or _welds_borders(job) else np.zeros_like(border)
        for _, vertices in seams:
            mask[vertices] = True
        weldable += [mask] * len(copies)
    surface = joined(placements)
    # Not more than a tenth of an edge, however far from the origin the scene is.
    edge = mean_edge_length(surface)
    rounding = 8.0 * float(np.finfo(np.float32).eps) * float(np.abs(surface.vertices).max())
    near = min(max(NEAR * edge, rounding), 0.1 * edge)
    names = first.name if len(jobs) == 1 else ", ".join(job.name for job in jobs)
    combined = DenoiseJob(
        names,
        surface,
        first.settings,
        first.linear if len(jobs) == 1 else np.eye(3),
        _combined(members, [job.movable for job in jobs], True),
        _region(members, np.concatenate(weldable), near),
    )
    return Assembly(combined, members)


def _join(motion: NDArray[np.float64], step: Step) -> None:
    """Let vertices that a step joins move alike; `motion`, shape (N, 3), is changed."""
    import numpy as np

    for matrix, first, second in step.joints:
        turn = matrix[:3, :3]
        both = (motion[first] + motion[second] @ turn.T) / 2.0
        both[:, step.stays] = 0.0
        motion[first], motion[second] = both, both @ np.linalg.inv(turn).T
        own = first[first == second]  # which move only in ways that the step leaves as they are
        _, values, ways = np.linalg.svd(np.eye(3) - turn)
        kept = ways[values < 1e-6]
        motion[own] = motion[own] @ kept.T @ kept


def _on_planes(
    surface: SurfaceMesh, mirrors: Sequence[Plane], border: NDArray[np.bool_]
) -> tuple[SurfaceMesh, list[tuple[NDArray[np.float64], NDArray[np.intp]]]]:
    """Return a mesh with the borders that are next to planes in them, and which vertices these are."""
    import numpy as np

    vertices = surface.vertices.astype(np.float64)
    seams = []
    for normal, point, distance in mirrors:
        height = (vertices - point) @ normal
        near = np.flatnonzero(border & (np.abs(height) <= distance))
        vertices[near] -= np.outer(height[near], normal)
        seams.append((normal, near))
    return surface.with_vertices(vertices), seams


def _copies(
    surface: SurfaceMesh,
    mirrors: Sequence[Plane],
    seams: Sequence[tuple[NDArray[np.float64], NDArray[np.intp]]],
    linear: NDArray[np.float64],
    origin: NDArray[np.float64],
) -> list[Placement]:
    """Return a mesh at its place and all of its images in planes that it reaches; the first is the mesh."""
    import numpy as np

    from ...core.mesh.joined import Placement

    maps = [(np.eye(3), np.zeros(3))]
    for (normal, point, _), (_, vertices) in zip(mirrors, seams, strict=True):
        if len(vertices):
            turn = np.eye(3) - 2.0 * np.outer(normal, normal)
            shift = 2.0 * (point @ normal) * normal
            maps += [(turn @ part, turn @ moved + shift) for part, moved in maps]
    return [Placement(surface, linear @ part, linear @ moved + origin) for part, moved in maps]


def _region(members: Sequence[Member], weldable: NDArray[np.bool_], near: float) -> Region:
    """Return the limits of several jobs as those of one; of lengths the least counts."""
    import numpy as np

    from ...core import Region

    regions = [member.job.region or Region() for member in members]
    scales = [float(np.linalg.norm(member.linear, 2)) for member in members]
    limits = [
        region.max_displacement * scale
        for region, scale in zip(regions, scales, strict=True)
        if region.max_displacement is not None
    ]
    edges, start = [], 0
    for member, region in zip(members, regions, strict=True):
        for _ in range(member.n_copies):
            if region.feature_edges is not None:
                edges.append(np.asarray(region.feature_edges) + start)
            start += member.job.surface.n_vertices
    distances = [region.weld_distance or 0.0 for region in regions]
    wide = max(distance * scale for distance, scale in zip(distances, scales, strict=True))
    return replace(
        regions[0],
        weights=_combined(members, [region.weights for region in regions], 1.0),
        feature_edges=np.concatenate(edges) if edges else None,
        max_displacement=min(limits, default=None),
        weld_distance=max(near, wide),
        weldable=None if wide else weldable,
    )


def _combined(
    members: Sequence[Member], values: Sequence[NDArray[Any] | None], default: object
) -> NDArray[Any] | None:
    """Return one value for each vertex of all copies, shape (n,); None if no job has any."""
    import numpy as np

    if all(each is None for each in values):
        return None
    found = []
    for member, each in zip(members, values, strict=True):
        own = np.full(member.job.surface.n_vertices, default) if each is None else np.asarray(each)
        found += [own] * member.n_copies
    return np.concatenate(found)


def _welds_borders(job: DenoiseJob) -> bool:
    """Tell whether the borders of a job's own mesh are welded."""
    return job.region is not None and job.region.weld_distance is not None
