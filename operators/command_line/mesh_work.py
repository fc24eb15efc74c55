# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What subcommands on mesh files have in common: each mesh of a file once, and what is said about it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .messages import FAILURE, CommandError, Messages

if TYPE_CHECKING:
    import bpy

    from .importing import Surfaces


class Outcome(NamedTuple):
    """What came of the meshes of a file, each given by the first object that has it."""

    done: list[tuple[bpy.types.Object, Any]]
    """Objects, and what the work on them gave."""
    refusals: list[tuple[bpy.types.Object, str]]
    """Objects whose meshes were left as they are, and why."""

    @property
    def refused_objects(self) -> list[bpy.types.Object]:
        """The objects whose meshes were left as they are."""
        return [obj for obj, _reason in self.refusals]


def check_blender() -> None:
    """Raise CommandError where there is no Blender."""
    from .blender_output import captured_output

    try:
        with captured_output():
            import bpy  # noqa: F401
    except ImportError as error:
        raise CommandError(
            f"Blender cannot be used from this Python ({error}); install the module with 'pip install bpy', "
            "or use 'blender -c framelet'.",
            FAILURE,
        ) from error


def work_on_meshes(
    source: Path, surfaces: Surfaces, messages: Messages, work: Callable[[bpy.types.Object], Any]
) -> Outcome:
    """Work on each mesh of a file once; objects that share one share the result.

    Parameters
    ----------
    source : Path
        The file, for the error.
    surfaces : Surfaces
        Its objects.
    messages : Messages
        Takes warnings about meshes that are skipped.
    work : callable
        Takes an object; raises ValueError with a sentence if it has to leave it as it is.

    Raises
    ------
    CommandError
        If nothing at all could be done, with the first reason.
    """
    outcome = Outcome([], [])
    seen: set[bpy.types.Mesh] = set()
    for obj in surfaces.objects:
        if obj.data in seen:
            continue
        seen.add(obj.data)
        try:
            outcome.done.append((obj, work(obj)))
        except ValueError as error:
            outcome.refusals.append((obj, str(error)))
    if not outcome.done:
        raise CommandError(f"{source}: {outcome.refusals[0][1]}")
    for _obj, reason in outcome.refusals:
        messages.warn(f"{reason} It was skipped.")
    return outcome


def describe_input(source: Path, surfaces: Surfaces) -> str:
    """Say how large the input is."""
    meshes = {obj.data for obj in surfaces.objects}
    n_vertices, n_faces = sum(len(m.vertices) for m in meshes), sum(len(m.polygons) for m in meshes)
    text = f"Read {source}: {n_vertices:,} vertices, {n_faces:,} faces"
    if len(surfaces.objects) > 1:
        return f"{text} in {len(surfaces.objects)} objects."
    size = " x ".join(f"{length:.4g}" for length in surfaces.objects[0].dimensions)
    return f"{text}, size {size}."


def count(number: int, noun: str) -> str:
    """Return a number with its noun."""
    return f"{number:,} {noun}{'' if number == 1 else 'es' if noun.endswith('s') else 's'}"
