# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What subcommands on mesh files have in common: each surface of a file once, and what is said about it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ..files.mesh_file import FileError
from .messages import CommandError, Messages


class Outcome(NamedTuple):
    """What came of the surfaces of a file, each given by its name."""

    done: list[tuple[str, Any]]
    """What the work on them gave."""
    refusals: list[tuple[str, str]]
    """Those that were left as they are, and why."""

    @property
    def refused(self) -> set[str]:
        """The names of those that were left as they are."""
        return {name for name, _reason in self.refusals}


def work_on_each(
    source: Path, items: Iterable[tuple[str, Any]], messages: Messages, work: Callable[[Any], Any]
) -> Outcome:
    """Work on each surface of a file.

    Parameters
    ----------
    source : Path
        The file, for the error.
    items : iterable of (str, object)
        Names, and what `work` takes.
    messages : Messages
        Takes warnings about surfaces that are skipped.
    work : callable
        Raises ValueError with a sentence if it has to leave a surface as it is.

    Raises
    ------
    CommandError
        If nothing at all could be done, with the first reason.
    """
    outcome = Outcome([], [])
    for name, item in items:
        try:
            outcome.done.append((name, work(item)))
        except FileError:
            raise  # of the disk, not of the surface
        except ValueError as error:
            outcome.refusals.append((name, str(error)))
    if not outcome.done:
        raise CommandError(f"{source}: {outcome.refusals[0][1]}")
    for _name, reason in outcome.refusals:
        messages.warn(f"{reason} It was skipped.")
    return outcome


def describe_input(source: Path, n_vertices: int, n_faces: int, n_objects: int, size: Iterable[float]) -> str:
    """Say how large the input is."""
    text = f"Read {source}: {n_vertices:,} vertices, {n_faces:,} faces"
    if n_objects > 1:
        return f"{text} in {n_objects} objects."
    return f"{text}, size {' x '.join(f'{length:.4g}' for length in size)}."


def count(number: int, noun: str) -> str:
    """Return a number with its noun."""
    return f"{number:,} {noun}{'' if number == 1 else 'es' if noun.endswith('s') else 's'}"
