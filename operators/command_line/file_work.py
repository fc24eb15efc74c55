# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on the surfaces of a mesh file without Blender, and write the file that comes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .mesh_work import describe_input
from .messages import CommandError, Messages

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core import Region, SurfaceMesh
    from ...core.mesh.weld import Weld
    from ..files import MeshFile, Part
    from ..files.safe_write import Outputs
    from ..properties.region_options import RegionOptions


class OpenedFile(NamedTuple):
    """A file, and where its vertices are by now."""

    source: Path
    file: MeshFile
    positions: NDArray[np.float64]
    """Shape (N, 3); changed by `work`."""

    def parts(self) -> list[tuple[str, Part]]:
        """Return the surfaces with their names."""
        return [(part.name, part) for part in self.file.parts()]

    def whole(self) -> tuple[str, Part]:
        """Return all surfaces as one."""
        import numpy as np

        from ..files import Part

        part = Part(self.file.name, np.arange(self.file.n_faces), np.arange(len(self.file.positions)))
        return part.name, part


def open_source(source: Path, messages: Messages) -> OpenedFile:
    """Read a file and say what is in it."""
    import numpy as np

    from ..files import open_file

    file = open_file(source)
    for sentence in file.warnings:
        messages.warn(f"{source}: {sentence}")
    points = file.positions
    with np.errstate(over="ignore", invalid="ignore"):  # of what is no number
        size = np.ptp(points, axis=0) if len(points) else np.zeros(3)
    messages.say(describe_input(source, len(points), file.n_faces, len(file.parts()), size))
    return OpenedFile(source, file, points.copy())


def surface_to_work_on(opened: OpenedFile, part: Part) -> SurfaceMesh:
    """Return the mesh of a part.

    Raises
    ------
    ValueError
        With a sentence that names the part, if it has no faces.
    """
    from ..files.surface import surface_of

    surface = surface_of(opened.file, part)
    if not surface.n_faces:
        raise ValueError(f"‘{part.name}’ has no faces; Framelet works on surfaces.")
    return surface


def move(
    opened: OpenedFile,
    part: Part,
    messages: Messages,
    work: Callable[[SurfaceMesh], NDArray[np.floating]],
) -> None:
    """Move the vertices of a part to where `work` puts them; what it refuses gets the name of the part.

    Raises
    ------
    ValueError
        With a sentence that names the part.
    """
    surface = surface_to_work_on(opened, part)
    warn_of_coarseness(opened.source, part.name, surface, messages)
    try:
        opened.positions[part.vertices] = work(surface)
    except ValueError as error:
        raise ValueError(f"‘{part.name}’: {error}") from error


def warn_of_coarseness(source: Path, name: str, surface: SurfaceMesh, messages: Messages) -> None:
    """Warn if the file holds positions in steps that can be seen."""
    from ...core.mesh.geometry import mean_edge_length
    from ..mesh_io.coarseness import coarse_step

    step = coarse_step(surface.vertices, mean_edge_length(surface))
    if step:
        messages.warn(
            f"‘{name}’ is far from the origin of {source}, where its positions come in steps of {step:.2g} "
            "mean edge lengths; write the file with double precision, or closer to the origin."
        )


def region_of(
    opened: OpenedFile, part: Part, surface: SurfaceMesh, options: RegionOptions
) -> tuple[NDArray[np.bool_] | None, Region]:
    """Return which vertices of a part may move, and what else limits a run.

    Vertices at the same place move together where the format splits what is one vertex, as glTF does, or
    where they lie on open borders, as at the seams of UVs.

    Raises
    ------
    ValueError
        With a sentence, if the part has no such vertex group.
    """
    from dataclasses import replace

    from ...core.mesh.borders import border_vertices
    from ...core.mesh.checks import check_positions
    from ...core.mesh.geometry import mean_edge_length

    check_positions(surface)
    weights = None
    if options.vertex_group:
        weights = opened.file.weights(options.vertex_group)
        if weights is None:
            raise ValueError(f"It has no vertex group ‘{options.vertex_group}’; choose one that it has.")
        weights = weights[part.vertices]
    if options.face_set:
        raise ValueError("It has no face sets; leave out --face-set.")
    edge = mean_edge_length(surface) if options.limit == "EDGES" else 0.0
    region = options.region(edge, 1.0, weights, border=border_vertices(surface))
    if opened.file.always_welded and not region.weld_distance:
        region = replace(region, weld_distance=0.0, weldable=None)
    movable = opened.file.movable()
    return None if movable is None else movable[part.vertices], region


def weld_of(opened: OpenedFile, surface: SurfaceMesh) -> Weld | None:
    """Return a mesh in which vertices that the file had to split are one again; None if there are none.

    Raises
    ------
    ValueError
        In one sentence, if the mesh cannot be worked on.
    """
    from ...core.mesh.borders import border_vertices
    from ...core.mesh.checks import check_positions
    from ...core.mesh.weld import make_weld

    check_positions(surface)
    weld = make_weld(surface, 0.0, None if opened.file.always_welded else border_vertices(surface))
    return weld if weld.n_merged else None


def write_target(
    opened: OpenedFile,
    target: Path,
    outputs: Outputs,
    messages: Messages,
    own: Mapping[str, str] | None = None,
) -> None:
    """Write the file, and what belongs to it, into the outputs; of `own` see `write_sidecars`.

    Raises
    ------
    CommandError
        If the type of the target cannot be written.
    FileError
        If something cannot be written.
    """
    from ..files.convert import converted
    from ..files.sidecars import write_sidecars

    kind, old_kind = target.suffix.lower(), opened.source.suffix.lower()
    if kind != old_kind:
        data, lost = converted(opened.file, opened.positions, kind)
        if lost:
            messages.warn(
                f"A {kind} file made of a {old_kind} file holds positions and faces only; left out: "
                f"{', '.join(lost)}."
            )
        outputs.write(target, data)
        return
    for sentence in write_sidecars(opened.file, opened.positions, opened.source, target, outputs, own or {}):
        messages.warn(sentence)
    if opened.file.has_stale_normals(opened.positions):
        messages.warn(
            f"{target} keeps its normals, which are those of the noisy surface; most programs compute them "
            "anew on request."
        )
    outputs.write(target, opened.file.patched(opened.positions))


def refuse_blender_options(arguments_output: str, target: Path) -> None:
    """Raise CommandError if a result is to go where only a .blend file has a place for it."""
    from ..properties.output_choices import IN_PLACE
    from .arguments import as_word
    from .file_types import BLEND, file_type
    from .messages import USAGE_ERROR

    if arguments_output != IN_PLACE and file_type(target) != BLEND:
        raise CommandError(
            f"--output {as_word(arguments_output)} needs a .blend file as OUT, but {target} is none.",
            USAGE_ERROR,
        )
